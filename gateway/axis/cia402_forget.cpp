// One table says which values each cause discards, so that no place that ends a motion keeps a value that another one drops. A set-point
// that outlives its motion would move the axis without a request.
#include <algorithm>
#include <utility>

#include "gateway/axis/cia402.hpp"

namespace axisgate {

void Cia402Axis::State::forget(Cause cause) {
    struct Wish {
        enum : unsigned {
            active = 1u << 0,
            buffered = 1u << 1,
            ordered_velocity = 1u << 2,
            asked_velocity = 1u << 3,
            target_velocity = 1u << 4,
            acknowledgement = 1u << 5,
            halt = 1u << 6,
            stream = 1u << 7
        };
    };
    struct Row {
        Cause cause;
        unsigned wishes;
    };
    static constexpr Row rows[] = {
        {Cause::motion_ends, Wish::active | Wish::buffered | Wish::ordered_velocity | Wish::asked_velocity | Wish::target_velocity |
                                 Wish::acknowledgement | Wish::halt | Wish::stream},
        {Cause::fault, Wish::active | Wish::buffered},
        {Cause::halt_command, Wish::active | Wish::buffered | Wish::ordered_velocity | Wish::target_velocity},
        {Cause::halt_bit, Wish::ordered_velocity},
        {Cause::mode_left, Wish::ordered_velocity},
        {Cause::new_mode, Wish::buffered | Wish::target_velocity | Wish::acknowledgement},
        {Cause::stream_ends, Wish::target_velocity},
        {Cause::set_point, Wish::buffered},
        {Cause::motion_asked, Wish::buffered},
        {Cause::homing_asked, Wish::active | Wish::buffered},
        {Cause::homing_taken, Wish::ordered_velocity},
        {Cause::velocity_taken, Wish::active},
        {Cause::position_set, Wish::active},
        {Cause::arrival, Wish::active},
    };
    const unsigned wishes = std::ranges::find(rows, cause, &Row::cause)->wishes;
    if (wishes & Wish::active) active.reset();
    if (wishes & Wish::buffered) buffered.reset();
    if (wishes & Wish::ordered_velocity) ordered_velocity = 0;
    if (wishes & Wish::asked_velocity) asked_velocity.reset();
    if (wishes & Wish::target_velocity) {
        target_velocity = 0;
        ++forgotten;
    }
    if (wishes & Wish::acknowledgement) setpoint_acknowledged = false;
    if (wishes & Wish::halt) halted = false;
    if (wishes & Wish::stream) leave_stream();
}

/// Returns to the former mode, unless a client has chosen another one since.
void Cia402Axis::State::leave_stream() {
    if (!std::exchange(following, false) || !cia402::is_streamed(mode)) return;
    mode = mode_before;
    forget(Cause::stream_ends);
}

}  // namespace axisgate
