// CiA 402, what is forgotten: one table of causes, so that no place that ends a motion keeps a wish that another one drops. A wish that
// outlives its motion moves the axis when nobody has asked for it.
#include <algorithm>
#include <utility>

#include "gateway/axis/cia402.hpp"

namespace axisgate {

void Cia402Axis::forget(State& s, Cause cause) {
    enum Wish : unsigned {
        active = 1u << 0,
        buffered = 1u << 1,
        ordered_velocity = 1u << 2,
        asked_velocity = 1u << 3,
        target_velocity = 1u << 4,
        acknowledgement = 1u << 5,
        halt = 1u << 6,
        stream = 1u << 7
    };
    struct Row {
        Cause cause;
        unsigned wishes;
    };
    static constexpr Row rows[] = {
        {Cause::motion_ends, active | buffered | ordered_velocity | asked_velocity | target_velocity | acknowledgement | halt | stream},
        {Cause::fault, active | buffered},
        {Cause::halt_command, active | buffered | ordered_velocity | target_velocity},
        {Cause::halt_bit, ordered_velocity},
        {Cause::mode_left, ordered_velocity},
        {Cause::new_mode, buffered | target_velocity | acknowledgement},
        {Cause::stream_ends, target_velocity},
        {Cause::set_point, buffered},
        {Cause::motion_asked, buffered},
        {Cause::homing_asked, active | buffered},
        {Cause::homing_taken, ordered_velocity},
        {Cause::velocity_taken, active},
        {Cause::position_set, active},
        {Cause::arrival, active},
    };
    const unsigned wishes = std::ranges::find(rows, cause, &Row::cause)->wishes;
    if (wishes & active) s.active.reset();
    if (wishes & buffered) s.buffered.reset();
    if (wishes & ordered_velocity) s.ordered_velocity = 0;
    if (wishes & asked_velocity) s.asked_velocity.reset();
    if (wishes & target_velocity) {
        s.target_velocity = 0;
        ++s.forgotten;
    }
    if (wishes & acknowledgement) s.setpoint_acknowledged = false;
    if (wishes & halt) s.halted = false;
    if (wishes & stream) leave_stream(s);
}

/// Back to the mode before it, unless somebody has chosen another one since.
void Cia402Axis::leave_stream(State& s) {
    if (!std::exchange(s.following, false) || !cia402::is_streamed(s.mode)) return;
    s.mode = s.mode_before;
    forget(s, Cause::stream_ends);
}

}  // namespace axisgate
