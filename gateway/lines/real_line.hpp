// RealLine: the common part of all lines that use the kernel: reconnecting after every fault, the bounded send queue, the counters.
// The owner gives it frames to send, the transport (a derived class) reports what happens on the connection, and the owner receives
// LineEvents, only from handlers of the io_context. It never blocks and runs in the thread of the loop alone. A line may be closed or
// destroyed from inside its own events.
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

/// A frame that has waited this long is discarded and counted, because a command must not be carried out when its sender no longer
/// expects it. The drive's side of a line has no such limit: on a slow line its answers are sent late, but complete.
inline constexpr Duration stale_send_limit = std::chrono::seconds(2);

/// The loop and the clock of every real line. Both outlive the line.
struct LineBase {
    asio::io_context& io;
    const Clock& clock;
    PauseRange pauses{};
    Duration stale_after = stale_send_limit;  ///< zero: frames never become too old
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

    /// Starts one attempt to open; it ends with came_up() or went_down(), now or later.
    virtual void start() = 0;
    /// Releases everything that the attempt has acquired. The owner is not informed.
    virtual void stop() = 0;
    /// Called by close(): releases everything that outlives a single attempt.
    virtual void let_go() {}
    /// Sends the frames of the queue as far as the transport accepts them. Called once per turn of the loop in which frames were queued.
    virtual void flush() = 0;
    [[nodiscard]] virtual bool takes(const Frame& frame) const { return frame.kind == Frame::Kind::bytes; }
    /// The status text while the line is up; lines whose text changes after came_up() override it.
    [[nodiscard]] virtual std::string up_text() const { return text_; }

    /// The next four call the owner, who may close or destroy the line meanwhile: if they return false, return without touching the line.
    [[nodiscard]] bool came_up(std::string text);
    [[nodiscard]] bool deliver(const Frame& frame);
    [[nodiscard]] bool tell_sent(const Frame& frame);
    [[nodiscard]] bool tell_state(State state, bool up, std::string text);
    /// The attempt or the connection is over: stops, informs the owner if it was up, and tries again after a pause. Return after this call.
    void went_down(std::string why);
    /// Tries again now instead of after the pause; does nothing if the line is not down.
    void try_now();

    /// Changes the status text without informing the owner.
    void say(std::string text) { text_ = std::move(text); }
    /// Empties the queue; its frames count as dropped.
    void drop_all() noexcept;
    void flush_soon();
    void drop_stale(Instant now);
    void count_received(std::size_t frames, std::size_t bytes) noexcept;

    /// Wraps a handler so that it does nothing once the present attempt has ended or the line has been destroyed.
    template <class F>
    [[nodiscard]] auto guarded(F f) const {
        return [alive = std::weak_ptr<char>(attempt_), f = std::move(f)](auto&&... arguments) mutable {
            if (!alive.expired()) f(std::forward<decltype(arguments)>(arguments)...);
        };
    }
    /// The same for handlers that live from open() to close().
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
    std::shared_ptr<char> opened_;   // lives from open() to close()
    std::shared_ptr<char> attempt_;  // lives from one attempt to the next
    bool flush_posted_ = false;
    bool published_ = false;  // the owner has received a state since open()
    bool ever_up_ = false;
    bool received_ = false;  // a frame has been received since the line came up
    Instant up_since_{};
};

}  // namespace axisgate
