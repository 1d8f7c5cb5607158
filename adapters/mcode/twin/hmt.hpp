// hMT: what the closed-loop layer remembers beside its settings: timers and flags of lead, lag and locked rotor.
// In: nothing by itself; the motor keeps it. Out: values.
// Never moves the rotor: twin_hmt.cpp, a part of the motor, does.
#pragma once

#include "gateway/core/instant.hpp"

namespace axisgate::mcode::twin {

/// Fixed acceleration and start speed of make-up, in steps of 51200 per turn [L7578].
inline constexpr double makeup_acceleration = 16'763'806;
inline constexpr double makeup_start = 916;
/// 3000 revolutions per minute: the most that make-up and torque mode run [L7567-7574].
inline constexpr double top_turns_per_second = 50;

struct Hmt {
    bool locked = false;         ///< LR
    bool at_bounds = false;      ///< AF 4: rotor at the control bounds
    bool lead_limit = false;     ///< AF 1
    bool lag_limit = false;      ///< AF 2
    bool while_braking = false;  ///< the disturbance came in the deceleration: make-up creeps at VI with MU = 0
    bool torque_runs = false;    ///< AS = 3 and not stopped by ESC
    Instant lock_due = never;    ///< when LR is set if the rotor does not move
};

}  // namespace axisgate::mcode::twin
