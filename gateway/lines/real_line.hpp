// RealLine: what all lines with a kernel behind them have in common: opening again after every fault, the bounded queue, the counters.
// In: frames to send; what the transport (a derived class) reports. Out: LineEvents, from handlers of the io_context alone.
// Never blocks; single thread: everything runs in the loop's thread. A line may be closed or destroyed from inside its own events.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <string>
#include <utility>

#include "gateway/core/line.hpp"
#include "gateway/lines/clock.hpp"
#include "gateway/lines/pauses.hpp"
#include "gateway/wire/load_meter.hpp"
#include "gateway/wire/send_queue.hpp"

namespace axisgate {

namespace asio = boost::asio;

/// A frame that has waited this long is thrown away and counted: a command must not be carried out when nobody expects it any more.
/// The drive's side of a line has no such limit: what it says is said late on a slow line, and whole.
inline constexpr Duration stale_send_limit = std::chrono::seconds(2);

/// What every real line is built on. Both outlive the line.
struct LineBase {
    asio::io_context& io;
    const Clock& clock;
    PauseRange pauses{};
    Duration stale_after = stale_send_limit;  ///< zero: what waits is never too old
};

class RealLine : public Line {
public:
    explicit RealLine(const LineBase& base);
    RealLine(const RealLine&) = delete;
    RealLine& operator=(const RealLine&) = delete;

    void open(LineEvents& events, Instant now) final;
    void close() final;
    bool send(const Frame& frame, Priority priority, Instant now) final;
    [[nodiscard]] Instant deadline() const final { return never; }
    void on_deadline(Instant) final {}
    [[nodiscard]] LineStatus status(Instant now) const final;

protected:
    using State = LineStatus::State;

    /// One attempt to open; it ends in came_up() or went_down(), now or later.
    virtual void start() = 0;
    /// Lets go of everything that the attempt has got. Tells nobody.
    virtual void stop() = 0;
    /// close() lets go of what outlives a single attempt.
    virtual void let_go() {}
    /// Sends what the queue holds, as far as the transport takes it. Called from the loop once per turn in which frames came.
    virtual void flush() = 0;
    [[nodiscard]] virtual bool takes(const Frame& frame) const { return frame.kind == Frame::Kind::bytes; }
    /// What the status says while the line is up; lines that can tell more than they said at came_up() do it here.
    [[nodiscard]] virtual std::string up_text() const { return text_; }

    /// These four call the owner, who may close or destroy the line meanwhile: where they return false, return without touching it.
    [[nodiscard]] bool came_up(std::string text);
    [[nodiscard]] bool deliver(const Frame& frame);
    [[nodiscard]] bool tell_sent(const Frame& frame);
    [[nodiscard]] bool tell_state(State state, bool up, std::string text);
    /// The attempt or the connection is over: stops, tells the owner if that is news, and tries again after a pause. Return after it.
    void went_down(std::string why);
    /// Tries again now instead of after the pause; nothing if the line is not down.
    void try_now();

    /// Changes what the status says without telling the owner.
    void say(std::string text) { text_ = std::move(text); }
    /// Empties the queue; what was in it counts as dropped.
    void drop_all() noexcept;
    void flush_soon();
    void drop_stale(Instant now);
    void count_received(std::size_t frames, std::size_t bytes) noexcept;

    /// Wraps a handler so that it does nothing once the present attempt is over (or the line gone).
    template <class F>
    [[nodiscard]] auto guarded(F f) const {
        return [alive = std::weak_ptr<char>(attempt_), f = std::move(f)](auto&&... arguments) mutable {
            if (!alive.expired()) f(std::forward<decltype(arguments)>(arguments)...);
        };
    }
    /// The same for what lives from open() to close().
    template <class F>
    [[nodiscard]] auto guarded_while_open(F f) const {
        return [alive = std::weak_ptr<char>(opened_), f = std::move(f)](auto&&... arguments) mutable {
            if (!alive.expired()) f(std::forward<decltype(arguments)>(arguments)...);
        };
    }

    [[nodiscard]] std::weak_ptr<char> open_life() const noexcept { return opened_; }
    [[nodiscard]] asio::io_context& io() const noexcept { return base_.io; }
    [[nodiscard]] const Clock& clock() const noexcept { return base_.clock; }
    [[nodiscard]] State state() const noexcept { return status_.state; }

    SendQueue queue_;
    LineStatus status_;
    LoadMeter load_in_, load_out_;
    bool one_wire_ = true;  ///< both directions share the bit rate

private:
    void attempt();
    void retry_after(Duration pause);

    LineBase base_;
    LineEvents* events_ = nullptr;
    std::string text_;
    asio::steady_timer retry_;
    GrowingPause pause_;
    std::shared_ptr<char> opened_;   // from open() to close()
    std::shared_ptr<char> attempt_;  // from one attempt to the next
    bool flush_posted_ = false;
    bool published_ = false;  // the owner has heard a state since open()
    bool ever_up_ = false;
    bool received_ = false;  // something came in since the line came up
    Instant up_since_{};
};

}  // namespace axisgate
