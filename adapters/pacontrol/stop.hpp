// Stops: quick stop, halt and disable: before everything that waits, after the exchange in progress at most.
// In: the three urgent commands, supervision. Out: 0A9A (0A93 while something is processed), 0A98, 0600, 0A81, 0603; their results.
// Never lets a motion outlive a stop: what waits is ended as interrupted; a stop that is refused becomes one of all axes.
#pragma once

#include "adapters/pacontrol/drive_jobs.hpp"

namespace axisgate::pacontrol {

class Stops : public Part {
public:
    enum class Kind : std::uint8_t { quick, halt, off };
    using Part::Part;

    void submit(Axis& a, const Command& command, Turn& t);
    /// Nobody has asked for it: nobody could stop the axis any more, or what was to move with it does not.
    void add(Kind kind, const Axis& a) { (void)waiting_.add({.kind = kind, .axis = a.place()}); }
    /// What a way over home position has given power again, although it was disabled, is switched off anew.
    void keep_off();
    void fail_all(Reason reason, const std::string& text, Turn& t);
    void forget() noexcept { supervise_at_ = never; }

    [[nodiscard]] bool ready() const noexcept;
    /// A quick stop or a power-off of this axis is on its way.
    [[nodiscard]] const CommandBody* locking(const Axis& a) const noexcept;
    void send(Turn& t);
    void answered(const Sent& sent, const Reply& reply, Turn& t);
    void not_read(const Reply& reply, Turn& t);
    void silent(Turn& t);
    void in_step();
    void on_deadline(Turn& t);
    [[nodiscard]] Instant deadline() const noexcept { return supervise_at_; }

private:
    struct Stop {
        Kind kind = Kind::quick;
        std::size_t axis = 0;
        Command command{};
        std::uint8_t tries = 0;
        std::uint8_t level = 0;  ///< 0: the axis; 1: 0600 stops all; 2: 0A81
        bool blind = false;      ///< sent while answers could not be told apart: sent again afterwards
        bool stopped = false;    ///< off during processing: 0A93 has passed, 0A98 has to wait
        bool by_abort = false;   ///< 0A9A is not taken now: 0A93 stops it
        Instant limit = never;   ///< off in home position: of the start of ONLINE
    };
    void interrupt(Axis& a, std::string_view by, bool power_off, Turn& t);
    [[nodiscard]] bool may_go(const Stop& s) const noexcept;
    [[nodiscard]] Request request_of(const Stop& s) const;
    [[nodiscard]] bool goes_online(const Stop& s) const noexcept;
    void over(Stop& s, Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code = 0);
    void found_standing(Stop& s, Turn& t);
    void refused(Stop& s, std::uint16_t code, const Sent& sent, Turn& t);
    [[nodiscard]] bool goes_another_way(Stop& s, std::uint16_t what, const Reply& reply, Turn& t);
    void abort_answered(Stop& s, const Reply& reply, Instant now);

    drive::StopLane<Stop, Control::stop_limit> waiting_;
    Stop* sent_ = nullptr;  ///< whose exchange is on its way, or was last
    Instant supervise_at_ = never;
    std::size_t supervised_ = 0;
};

}  // namespace axisgate::pacontrol
