// The traverse task of one axis: start, end, interruption, reference run, watchdog, what stops it by itself.
// In: motions, switches, time. Out: the path of the shaft, why the task ended, faults.
// Never switches power on, never moves a shaft whose axis is off, faulty or displaced.
#pragma once

#include "adapters/pacontrol/twin/errors.hpp"
#include "adapters/pacontrol/twin/switches.hpp"

namespace axisgate::pacontrol::twin {

enum class Task : std::uint8_t { none, position, manual, reference, jog };

struct Motion {
    Task task = Task::position;
    double target = 0;             ///< AE, absolute
    double speed = 0;              ///< AE/s
    double acceleration = 0;       ///< AE/s^2
    bool free = false;             ///< no reference and range check (control bits 10, 11 and the front panel)
    bool limits_monitored = true;  ///< false: passes over actuated limit switches
};

class Traverse {
public:
    Traverse(const AxisModel& model, const AxisParameters& parameters, AxisState& state, Shaft& shaft, Switches& switches)
        : model_(model), p_(parameters), state_(state), shaft_(shaft), switches_(switches) {}
    Traverse(const Traverse&) = delete;
    Traverse& operator=(const Traverse&) = delete;

    /// A task is not finished yet, be it interrupted.
    [[nodiscard]] bool busy() const noexcept { return shaft_.running() || interrupted_; }
    [[nodiscard]] bool interrupted() const noexcept { return interrupted_; }
    [[nodiscard]] Task task() const noexcept { return task_; }
    [[nodiscard]] bool stopped() const noexcept { return stopped_; }  ///< the last one did not reach its target
    [[nodiscard]] bool stopped_by_condition() const noexcept { return stopped_by_condition_; }
    /// Why the last task ended: 0, or a command error.
    [[nodiscard]] std::uint16_t ended_with() const noexcept { return ended_with_; }
    [[nodiscard]] double last_target() const noexcept { return target_; }                                            ///< AE, SR71..
    [[nodiscard]] double area_min() const noexcept { return static_cast<double>(p_[ap::area_min]) + state_.shift; }  ///< AE
    [[nodiscard]] double area_max() const noexcept { return static_cast<double>(p_[ap::area_max]) + state_.shift; }

    // --- 0, or a command error: then nothing happened ---
    [[nodiscard]] std::uint16_t may_start(const Motion& m, Instant t) const;
    /// Starts what `may_start` allows.
    void start(const Motion& m, Instant t);
    [[nodiscard]] std::uint16_t may_reference() const;
    void start_reference(Instant t);
    /// Ends the task by a ramp; it counts as finished there.
    void finish(Instant t);
    /// Ends it because a condition ceased to hold (G123).
    void finish_by_condition(Instant t);
    void skipped_by_condition() noexcept;
    /// Stops by a ramp, to go on by `resume`.
    void interrupt(Instant t);
    void resume(Instant t);
    void forget_interrupted() noexcept { interrupted_ = false; }
    /// A manual move lives on for a second.
    void renew(Instant t) noexcept;
    void change_speed(double speed, Instant t);
    /// Stands at once where it is, with a system error, of which the task ends with `code`.
    void abort_with(std::uint16_t number, std::uint16_t code, Instant t);
    /// Stands at once where it is, and there is no task any more.
    void drop(Instant t);
    void boot() noexcept;
    /// The counter has another value: that is the last target.
    void renamed() noexcept { target_ = shaft_.rest(); }

    // --- what comes up by itself ---
    /// The hand has actuated a limit switch, or changed the home switch.
    void limit_changed(Instant t);
    void home_changed(bool active, Instant t);
    /// Before `advance`, and before anything else changes: the mechanics follow up to `t`.
    void follow(Instant t);
    void advance(Instant t);
    [[nodiscard]] Instant deadline() const noexcept;

private:
    enum class Phase : std::uint8_t { none, seek, creep_out, creep_back };
    void run(const Path& path, Instant t);
    void stand() noexcept;
    void path_ended(Instant t);
    void next_phase(Instant t);
    void ramp_down(Instant t);
    void hit_limit(bool positive, Instant t);
    /// AE that the following error may have; 0: it is not monitored.
    [[nodiscard]] double most_lag() const noexcept;
    [[nodiscard]] Instant lag_exceeded() const noexcept;
    [[nodiscard]] Instant limit_passed() const noexcept;

    const AxisModel& model_;
    const AxisParameters& p_;
    AxisState& state_;
    Shaft& shaft_;
    Switches& switches_;
    Motion motion_;
    Task task_ = Task::none;
    Phase phase_ = Phase::none;
    Instant watchdog_ = never;
    Instant lagged_ = never;  ///< the lag of the mechanics was too large then, which has not been dealt with
    double target_ = 0;
    bool braking_ = false;  ///< the ramp of an end or an interruption
    bool interrupted_ = false;
    bool want_interrupt_ = false;
    bool stopped_ = false;
    bool stopped_by_condition_ = false;
    std::uint16_t ended_with_ = 0;
};

}  // namespace axisgate::pacontrol::twin
