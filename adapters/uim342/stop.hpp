// Stops: quick stop, halt and disable: sent at once, before everything that waits and beside the exchange in progress.
// In: the three urgent commands, a joint stop, what supervision finds. Out: ST, MO=0, or JV=0 and BG, urgent; their results.
// Never lets a motion outlive a stop: what waits is ended as interrupted, and if a BG may still be on its way behind the stop
// (the line lets urgent frames overtake), the stop is repeated behind it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "adapters/uim342/drive_part.hpp"
#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/exchange.hpp"

namespace axisgate::uim342 {

struct Stop {
    enum class Kind : std::uint8_t { quick, off, halt };
    Kind kind = Kind::quick;
    bool waiting = false;  ///< halt: the exchange of a motion in progress has to end first
    bool soft = false;     ///< halt by JV=0 and BG, not (yet) by ST
    bool begun = false;    ///< soft: JV=0 is acknowledged, BG is on its way
    bool by_supervision = false;
    bool shared = false;  ///< belongs to a joint stop: the adapter is told
    Ticket ticket = no_ticket;
    drive::Exchange<Message> exchange;
};

class Stops : public Part {
public:
    static constexpr std::size_t limit = 4;  ///< on their way at once; one more is sent, but cannot be watched
    using Part::Part;

    void add(const Command& command, Turn& t);
    /// An ST to all has been sent: one of its own, whose end the adapter is told.
    void add_shared(Turn& t);
    /// The gateway's own: what should stand does not.
    void enforce(Turn& t);
    void fail_all(Reason reason, const std::string& text, Turn& t);

    void answered(Stop& s, const Message& m, Turn& t);
    void refused(Stop& s, const Message& m, Turn& t);
    /// A halt may have waited for it.
    void exchange_ended(Turn& t);
    void on_deadline(Turn& t);
    [[nodiscard]] Instant deadline() const noexcept;
    /// The axis stands, or a new motion has begun: no ramp is watched any more.
    void ramp_over() noexcept { ramp_ = false, supervise_at_ = never; }

    /// A stop is to be repeated behind the motion that it may have overtaken.
    [[nodiscard]] bool to_repeat() const noexcept { return repeat_.has_value(); }
    void repeat(Turn& t);

    [[nodiscard]] bool empty() const noexcept { return lane_.empty(); }
    /// A quick stop or a power-off is on its way.
    [[nodiscard]] const CommandBody* locking() const noexcept;
    [[nodiscard]] bool ramp() const noexcept { return ramp_; }
    template <class F>
    void each(F&& f) {
        lane_.each(std::forward<F>(f));
    }

private:
    void add(const Stop& wanted, Turn& t);
    /// Every motion that waits or runs ends; with the power off so does what would bring that back.
    void interrupt(std::string_view by, bool power_off, Turn& t);
    void begin(Stop& s, Turn& t);
    void send(Stop& s, const Message& m, int retries, Turn& t);
    void silent(Stop& s, Turn& t);
    void harden(Stop& s, std::string_view why, Turn& t);
    void over(Stop& s, Outcome outcome, Reason reason, std::string text, std::int32_t code, Turn& t);
    void supervise(bool soft, Turn& t);
    void look(Turn& t);

    drive::StopLane<Stop, limit> lane_;
    std::optional<Stop::Kind> repeat_;
    bool ramp_ = false;             ///< an ST was acknowledged and the axis has not stood since
    Instant supervise_at_ = never;  ///< the axis must stand by then
    Instant acknowledged_at_{};     ///< of the stop that is watched
    Instant doubt_until_{};         ///< until then a speed of 0 is believed against a status that says "moving"
    bool supervise_soft_ = false;
};

}  // namespace axisgate::uim342
