// Course: the present motion: its profile, how it is braked or ends at once, how the rotor follows it, settling and hold delay.
// In: profiles, the hand's hold and load, instants. Out: phases; corrections, stalls, make-up and torque mode.
// Never chooses where to go: Moves and Homing do.
#pragma once

#include "adapters/mcode/twin/parts.hpp"

namespace axisgate::mcode::twin {

class Course {
public:
    enum class Task : std::uint8_t { none, position, slew, homing, jog, torque, calibration, correction };
    /// What the present motion is for.
    struct Demand {
        Task task = Task::none;
        bool braking = false;  ///< towards a stop that was asked for, or that a limit made
        bool aborted = false;  ///< stopped by a limit, input or fault: not a completion
        double target = 0;
        std::optional<double> second;  ///< second leg of mechanical backlash compensation
        bool go_on = false;            ///< third field of MA, MR
        Instant passing = never;       ///< when a move that goes on passes its target

        void shift(double by) noexcept {
            target += by;
            if (second) *second += by;
        }
    };
    /// What the tester's hand does to shaft and encoder; judge_rotor after a change.
    struct Touch {
        bool held = false;
        double load = 0;  ///< part of the full torque
        int encoder = 0;  ///< fault that SC 1 finds: 1 resolution, 2 direction, 3 both
    };

    explicit Course(Parts& parts) : p_(parts) {}
    void restart(Instant now) noexcept;

    Demand demand;
    Touch touch;

    [[nodiscard]] bool rests() const noexcept { return phase_ == Phase::rest; }
    [[nodiscard]] bool steps() const noexcept { return phase_ == Phase::steps; }
    [[nodiscard]] bool steps(Task task) const noexcept { return steps() && demand.task == task; }
    /// MP.
    [[nodiscard]] bool to_position() const noexcept;
    /// VC.
    [[nodiscard]] bool velocity_changing(Instant now) const noexcept { return steps() && p_.shaft.command().changing(now) != 0; }
    /// Percent of the full current.
    [[nodiscard]] int current(Instant now) const noexcept;
    /// ST.
    [[nodiscard]] bool stall_flag() const noexcept { return stall_flag_; }
    void clear_stall() noexcept { stall_flag_ = stall_reported_ = false; }
    /// Error of an instruction that moves; 0: it may.
    [[nodiscard]] int may_move(Word word) const;

    /// Another aim, from where the rotor is.
    void begin(Task task, Instant now) noexcept;
    /// A new profile of the command; the rotor follows it as it did before.
    void command(Profile p, Instant now);
    void slew(double velocity, Instant now);
    void move(double target, bool go_on, Instant now);
    void brake(Instant now);
    /// Stands at once, without a ramp.
    void freeze(Instant now);
    /// As freeze; it is no completion.
    void abort(Instant now);
    /// What seeks or turns becomes a motion that is only braked.
    void give_up() noexcept;
    /// At rest with an encoder in use: the command begins where the rotor is.
    void resync(Instant now) noexcept;
    /// The steps are given: MT begins.
    void settle(Instant now) noexcept;
    /// MT or HT is over. True: so is the motion.
    [[nodiscard]] bool pass_phase(Instant now);
    void forget_corrections() noexcept { corrections_ = 0; }

    /// The command is SF ahead of the rotor.
    void stalled(Instant now);
    /// What the real rotor does at this millisecond: SF is passed, or the motor falls out of step. True: the motion has changed.
    [[nodiscard]] bool notice(Instant now);
    struct Watched {
        bool rotor = false;  ///< an encoder compares it with the command
        bool step = false;   ///< the motor gives steps without a loop, and is in step
    };
    [[nodiscard]] Watched watched() const noexcept;
    void maintain(Instant now);
    void judge_rotor(Instant now);
    void run_torque(Instant now);
    void locked(Instant now);
    void unlock(Instant now);
    /// The shaft is turned by hand, at rest.
    void turn_to(double position, Instant now);

    /// The command is over and the rotor where it shall be.
    [[nodiscard]] Instant steps_end() const noexcept;
    [[nodiscard]] Instant phase_end() const noexcept { return phase_end_; }
    [[nodiscard]] Instant stall_due(Instant now) const noexcept;

private:
    enum class Phase : std::uint8_t {
        rest,
        steps,     ///< steps are given, or make-up is
        settling,  ///< MT
        holding    ///< HT
    };
    void step_on() noexcept;
    void stand_at(double position, Instant now) noexcept;
    void make_up(Instant now);
    void correct(Instant now);
    void in_step(Instant now);

    Parts& p_;
    Phase phase_ = Phase::rest;
    Instant phase_end_ = never;
    int corrections_ = 0;
    bool out_of_step_ = false;
    bool stall_flag_ = false;
    bool stall_reported_ = false;
};

/// SF is passed by a rotor that is shown so far from its place, in turns.
[[nodiscard]] bool stalls(const Parts& parts, Instant now, double stray) noexcept;

}  // namespace axisgate::mcode::twin
