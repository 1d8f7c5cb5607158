// ClosedLoop: hMT (AS = 1, 2, 3): lead and lag against their limits, make-up, the timer of the locked rotor [L7482-7590].
// In: the shaft, MU, MF, CB, LT, LG, LD. Out: how the rotor catches up, codes 87, 104 to 110, conditions of TA, AF.
// Never begins or ends a motion: Course does.
#pragma once

#include "adapters/mcode/twin/motor_events.hpp"
#include "adapters/mcode/twin/thermal.hpp"
#include "adapters/mcode/twin/trip_conditions.hpp"

namespace axisgate::mcode::twin {

class ClosedLoop {
public:
    ClosedLoop(const Settings& settings, Shaft& shaft, TripConditions& trips, MotorEvents& events)
        : settings_(settings), shaft_(shaft), trips_(trips), events_(events) {}

    void restart() noexcept { is_ = {}; }
    /// No limit of lead and lag is passed.
    void clear() noexcept { is_.at_bounds = is_.lag_limit = is_.lead_limit = false; }
    /// Nothing owed is looked at any more, and torque mode is over.
    void stop() noexcept;
    void set_torque(bool runs) noexcept { is_.torque_runs = runs; }
    /// AS = 3, and not stopped by ESC, an input or a limit.
    [[nodiscard]] bool torque_runs() const noexcept { return is_.torque_runs; }

    /// The rotor begins to be held.
    void disturbed(Instant now) noexcept { is_.while_braking = shaft_.command().changing(now) < 0; }
    /// Torque mode against a rotor that stands.
    void resist(Instant now) noexcept;
    /// The rotor turns: no timer runs.
    void turns() noexcept;
    /// Plans how the rotor runs after the command at the speed that MU gives, until both meet [L7556-7578]. False: nothing is owed.
    bool make_up(Instant now);
    void caught_up() noexcept;
    void judge_lag(Instant now);
    /// LR.
    void lock(Instant now);
    void unlock() noexcept { is_.locked = false; }

    /// The command may be over long before the motion is: the rotor owes steps, or stands against its torque.
    [[nodiscard]] bool waits_for_rotor() const noexcept;
    /// When a held rotor lags up to a limit.
    [[nodiscard]] Instant lag_due(Instant now) const noexcept;
    [[nodiscard]] Instant lock_due() const noexcept { return is_.lock_due; }
    [[nodiscard]] bool locked() const noexcept { return is_.locked; }
    [[nodiscard]] bool at_bounds() const noexcept { return is_.at_bounds; }
    [[nodiscard]] bool lead_limit() const noexcept { return is_.lead_limit; }
    [[nodiscard]] bool lag_limit() const noexcept { return is_.lag_limit; }
    /// AF.
    [[nodiscard]] int status(const Supply& supply, Instant now) const noexcept;

private:
    [[nodiscard]] double bound() const noexcept;
    void start_timer(Instant now) noexcept { is_.lock_due = now + std::chrono::milliseconds(settings_.whole(Word::LT)); }

    const Settings& settings_;
    Shaft& shaft_;
    TripConditions& trips_;
    MotorEvents& events_;
    struct {
        bool locked = false;         ///< LR
        bool at_bounds = false;      ///< AF 4: rotor at the control bounds
        bool lead_limit = false;     ///< AF 1
        bool lag_limit = false;      ///< AF 2
        bool while_braking = false;  ///< the disturbance came in the deceleration: make-up creeps at VI with MU = 0
        bool torque_runs = false;
        Instant lock_due = never;  ///< when LR is set if the rotor does not move
    } is_;
};

}  // namespace axisgate::mcode::twin
