// Feedback: what the control says of itself and of its axes, and what follows from it.
// In: acknowledgements. Out: feedback, notices, the ends of motions and of waits.
// Never mixes three different things: the command error (QUIT, of one command), the operating status, and the PA-CONTROL error (Exxx).
#pragma once

#include "adapters/pacontrol/demand.hpp"

namespace axisgate::pacontrol {

class Feedback : public Part {
public:
    using Part::Part;

    // --- what is received -----------------------------------------------------------------------------------------------------
    /// STATUS and ERROR of any acknowledgement.
    void learn(const Reply& reply, Turn& t);
    void poll_answered(const Poll& poll, const Reply& reply, Turn& t);
    void learn_status(Axis& a, int status, Turn& t);
    void learn_position(Axis& a, double units, Turn& t);
    void learn_position(Axis& a, const Reply& reply, Turn& t) { learn_position(a, number_of(reply).value_or(0), t); }

    // --- motions ----------------------------------------------------------------------------------------------------------------
    void begin_motion(Axis& a, Motion motion, Turn& t);
    /// It is over, reached or not. The position must have been read before.
    void end_motion(Axis& a, bool reached, Reason reason, const std::string& text, Turn& t);
    /// The command was taken: its result, or a wait for what it asked for.
    void accepted(Axis& a, const Command& c, Wait::For what, std::int64_t value, std::string text, Turn& t);
    void end_waits(Axis& a, Reason reason, const std::string& text, Turn& t, bool motions_only = true);

    void publish(Axis& a, Turn& t);
    void publish_all(Turn& t);

private:
    void mode_changed(int before, Turn& t);
    void left_online(int before, Turn& t);
    void ask_whose_fault(Turn& t);
    [[nodiscard]] bool shown_by_axes() const;
    void poll_refused(Axis& a, const Poll& poll, const Reply& reply, Turn& t);
    void learn_running(std::uint32_t mask, Turn& t);
    void learn_speed(Axis& a, double units, Turn& t);
    [[nodiscard]] bool shown_late(const Axis& a, std::int64_t position, Instant now) const;
    void learn_end(Axis& a, double units, Turn& t);
    void derive(Axis& a, Instant now);
    void watch_power(Axis& a, int before, Turn& t);
    void check_waits(Axis& a, Turn& t);
};

}  // namespace axisgate::pacontrol
