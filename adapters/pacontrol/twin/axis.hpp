// One axis of the twin: kinematics, reference flag, software limits and their shift, switches, following error, measuring mode.
// In: motions, parameters, outside conditions, time. Out: position, speed, status, errors.
// Never knows of operating modes or of other axes.
// Written in two files: axis.cpp motions and time, axis_state.cpp power, reference, switches and the tester's hand.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "adapters/pacontrol/twin/parameters.hpp"
#include "adapters/pacontrol/twin/path.hpp"

namespace axisgate::pacontrol::twin {

/// Command error numbers that an axis gives [L4036-4076].
namespace quit {
inline constexpr std::uint16_t ok = 0;
inline constexpr std::uint16_t inadmissible = 0x14;
inline constexpr std::uint16_t not_executable = 0x15;
inline constexpr std::uint16_t no_axis = 0x20;
inline constexpr std::uint16_t no_axis_parameter = 0x21;
inline constexpr std::uint16_t no_system_parameter = 0x22;
inline constexpr std::uint16_t no_input = 0x23;
inline constexpr std::uint16_t no_output = 0x24;
inline constexpr std::uint16_t no_flag = 0x25;
inline constexpr std::uint16_t no_n = 0x26;
inline constexpr std::uint16_t no_r = 0x27;
inline constexpr std::uint16_t value = 0x29;
inline constexpr std::uint16_t moves = 0x2A;
inline constexpr std::uint16_t no_reference = 0x2B;
inline constexpr std::uint16_t no_external_stop = 0x2C;
inline constexpr std::uint16_t not_ready = 0x2E;
inline constexpr std::uint16_t path_too_long = 0x36;
inline constexpr std::uint16_t switched_off = 0x37;
inline constexpr std::uint16_t displaced = 0x38;
inline constexpr std::uint16_t profibus_address = 0x39;
inline constexpr std::uint16_t limit_switch = 0x40;
inline constexpr std::uint16_t outside_range = 0x41;
inline constexpr std::uint16_t no_measuring = 0x6C;
}  // namespace quit

/// System error numbers: 205, 525, 529 and 560 are the manual's [L335, L716, L2825, L3812]; for the negative switch, the following error,
/// the power pack and a traverse that a program cannot start it names none, so these four are the model's own.
namespace error {
inline constexpr std::uint16_t rotary_switches = 205;
inline constexpr std::uint16_t no_reference = 525;
inline constexpr std::uint16_t limit_positive = 529;
inline constexpr std::uint16_t limit_negative = 530;
inline constexpr std::uint16_t following_error = 531;
inline constexpr std::uint16_t power_pack = 532;
inline constexpr std::uint16_t program_move = 533;
inline constexpr std::uint16_t no_encoder_edge = 560;
}  // namespace error

struct AxisModel {
    bool ep = true;                   ///< PA-CONTROL EP: encoder, temperature, speed change while moving
    bool measuring = true;            ///< the option measuring mode exists, else 6Ch
    bool manual_at_traverse = false;  ///< speed of 0A90/0A91: traverse speed instead of manual speed (E-32)
    int switch_on_mode = 1;       ///< 0: an interrupted traverse is dropped at axis ON; 1..3: it goes on; 4: and displacement is watched
    double max_displacement = 1;  ///< AE, while the axis is off, for switch_on_mode 4
    double travel_min = -10'050, travel_max = 10'050;  ///< AE of the shaft: where the switches at the ends of travel are
    double revolution = 0;  ///< AE; above 0 a rotary axis: one switch just before each whole turn, seen in both directions [L834]
    Duration watchdog = std::chrono::seconds(1);  ///< of a manual move [L3553]
};

/// Motor state as in the status word of the module interface [L734-L760].
enum class AxisPower : std::uint8_t { on, halt, idle, safe, disabled };

inline constexpr double switch_share = 0.01;  ///< of a turn of a rotary axis, on which its switch is actuated

enum class Task : std::uint8_t { none, position, manual, reference, jog };

struct Motion {
    Task task = Task::position;
    double target = 0;             ///< AE, absolute
    double speed = 0;              ///< AE/s
    double acceleration = 0;       ///< AE/s^2
    bool free = false;             ///< no reference and range check (control bits 10, 11 and the front panel)
    bool limits_monitored = true;  ///< false: passes over actuated limit switches
};

class Axis {
public:
    Axis(const AxisModel& model, const AxisParameters& parameters) : model_(model), p_(parameters) {}

    // --- what it is doing, at the instant of the last advance or later ---
    [[nodiscard]] double position(Instant t) const noexcept;  ///< AE, the control's counter
    [[nodiscard]] double velocity(Instant t) const noexcept;  ///< AE/s, signed
    [[nodiscard]] double shaft(Instant t) const noexcept;     ///< AE, the true place of the mechanics; the home switch's edge is at 0
    [[nodiscard]] double encoder(Instant t) const noexcept { return shaft(t) + origin_; }  ///< AE, counted by the encoder
    [[nodiscard]] double lag(Instant t) const noexcept;                                    ///< AE, following error
    [[nodiscard]] double greatest_lag(Instant t) const noexcept;  ///< AE, the largest that has occurred since power on
    [[nodiscard]] bool running() const noexcept { return running_; }
    /// A traverse task is not finished yet, be it interrupted.
    [[nodiscard]] bool busy() const noexcept { return running_ || interrupted_; }
    [[nodiscard]] bool interrupted() const noexcept { return interrupted_; }
    [[nodiscard]] Task task() const noexcept { return task_; }
    /// 0 in position, 1 moving, 2 stopped, 4 malfunction, 8 measuring mode [L2960].
    [[nodiscard]] std::uint8_t status() const noexcept;
    /// Why the last task ended: 0, or a command error.
    [[nodiscard]] std::uint16_t ended_with() const noexcept { return ended_with_; }
    [[nodiscard]] bool referenced() const noexcept { return referenced_; }
    [[nodiscard]] AxisPower power() const noexcept { return power_; }
    [[nodiscard]] bool switched_off() const noexcept { return off_; }  ///< axis ON was taken away
    [[nodiscard]] bool enabled() const noexcept { return power_ == AxisPower::on || power_ == AxisPower::halt; }
    [[nodiscard]] std::uint16_t fault() const noexcept { return fault_; }
    [[nodiscard]] bool measuring() const noexcept { return measuring_; }
    [[nodiscard]] bool stopped_by_condition() const noexcept { return stopped_by_condition_; }
    [[nodiscard]] bool displaced_while_off() const noexcept { return displaced_; }
    [[nodiscard]] double shift() const noexcept { return shift_; }
    [[nodiscard]] double last_target() const noexcept { return target_; }              ///< SR71..
    [[nodiscard]] double position_when_off() const noexcept { return off_position_; }  ///< SR51..
    /// At the instant of the last advance: by the place of the shaft, or by the hand.
    [[nodiscard]] bool limit_actuated(bool positive) const noexcept;
    [[nodiscard]] double area_min() const noexcept { return static_cast<double>(p_[ap::area_min]) + shift_; }
    [[nodiscard]] double area_max() const noexcept { return static_cast<double>(p_[ap::area_max]) + shift_; }
    [[nodiscard]] const AxisModel& model() const noexcept { return model_; }
    [[nodiscard]] const AxisParameters& parameters() const noexcept { return p_; }
    void set_parameter(std::size_t number, float value) noexcept { p_.at(number) = value; }
    void set_revolution(double ae) noexcept { model_.revolution = ae; }

    // --- motions (0, or a command error: then nothing happened) ---
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

    // --- position and reference ---
    void set_referenced(bool on) noexcept;
    void set_position_g26(double x, bool reference) noexcept;
    void set_position_g29(double x) noexcept;
    void delete_g29() noexcept;

    // --- power and measuring ---
    /// 0, or a command error. `go_on`: an interrupted traverse goes on by the switch-on mode; false while the control is stopped.
    [[nodiscard]] std::uint16_t switch_on(Instant t, bool go_on);
    void switch_off(Instant t);
    /// G140 (true) / G141: motor without power.
    void disable(bool disabled, Instant t);
    [[nodiscard]] std::uint16_t begin_measuring();
    [[nodiscard]] std::uint16_t end_measuring();
    void set_fault(std::uint16_t number, Instant t);
    void clear_fault() noexcept { fault_ = 0; }
    void clear_displaced() noexcept { displaced_ = false; }

    // --- time ---
    void advance(Instant t);
    [[nodiscard]] Instant deadline() const noexcept;
    /// A system error that came up by itself since the last call, or 0.
    [[nodiscard]] std::uint16_t take_error() noexcept { return std::exchange(raised_, std::uint16_t{0}); }
    /// The rest position, the counter or the reference flag changed: something to keep.
    [[nodiscard]] bool take_changed() noexcept { return std::exchange(changed_, false); }

    // --- the tester's hand ---
    void hold(bool held, Instant t);
    void set_limit(bool positive, bool actuated, Instant t);
    void set_home_switch(bool active, Instant t);
    void set_following_error(double ae, Instant t);
    void set_power_pack(bool ready, Instant t);
    void set_load(double share) noexcept { load_ = share; }
    [[nodiscard]] double load() const noexcept { return load_; }
    void set_temperature(double celsius) noexcept { temperature_ = celsius; }
    void set_encoder_broken(bool broken) noexcept { encoder_broken_ = broken; }
    /// False: the motor holds the shaft.
    [[nodiscard]] bool push_to(double ae, Instant t);
    /// Without supply anybody can push it; an absolute system sees it at the next power on.
    bool push_unpowered(double ae) noexcept;
    [[nodiscard]] bool held() const noexcept { return held_; }
    [[nodiscard]] bool home_switch() const noexcept { return home_forced_; }
    [[nodiscard]] bool limit_hand(bool positive) const noexcept { return positive ? limit_positive_ : limit_negative_; }
    [[nodiscard]] double extra_lag() const noexcept { return extra_lag_; }
    [[nodiscard]] bool power_pack() const noexcept { return power_pack_; }
    [[nodiscard]] double temperature() const noexcept { return temperature_; }
    [[nodiscard]] bool encoder_broken() const noexcept { return encoder_broken_; }

    // --- memory ---
    struct Kept {
        double position = 0, shaft = 0, shift = 0;
        bool referenced = false;
    };
    [[nodiscard]] Kept kept() const noexcept { return {rest_, rest_ - origin_ - lost_, shift_, referenced_}; }
    /// Power off: stands where it is.
    void lose_power(Instant t);
    /// Power on. With an absolute system position and reference come back, without it the counter begins at 0, unreferenced.
    void boot(const Kept& kept);

private:
    enum class Phase : std::uint8_t { none, seek, creep_out, creep_back };
    void run(const Path& path, Instant t);
    void stand(Instant t);
    void path_ended(Instant t);
    void next_phase(Instant t);
    void ramp_down(Instant t);
    void hit_limit(bool positive, Instant t);
    void abort_with(std::uint16_t number, std::uint16_t code, Instant t);
    [[nodiscard]] bool home_active() const noexcept;
    [[nodiscard]] Instant lag_exceeded() const noexcept;
    [[nodiscard]] Instant limit_passed() const noexcept;
    [[nodiscard]] bool switch_at_shaft(bool positive) const noexcept;
    [[nodiscard]] double edge_below(double shaft) const noexcept;
    void note_lag(Instant t) noexcept;

    AxisModel model_;
    AxisParameters p_;

    // Kinematics: `rest_` while it stands, `path_` while it moves. shaft = position - origin_ - lost_.
    double rest_ = 0;
    double origin_ = 0;
    double lost_ = 0;     ///< AE that the shaft did not follow
    double held_at_ = 0;  ///< commanded position at which the shaft was taken hold of
    double shift_ = 0;    ///< G29
    double target_ = 0;
    double extra_lag_ = 0;
    double greatest_lag_ = 0;
    Instant now_{};  ///< of the last advance
    double off_position_ = 0, off_shaft_ = 0;
    Path path_;
    Motion motion_;
    Task task_ = Task::none;
    Phase phase_ = Phase::none;
    Instant watchdog_ = never;
    bool running_ = false;
    bool braking_ = false;  ///< the ramp of an end or an interruption
    bool interrupted_ = false;
    bool want_interrupt_ = false;
    bool stopped_ = false;  ///< did not reach its target
    std::uint16_t ended_with_ = 0;

    AxisPower power_ = AxisPower::on;
    bool off_ = false;  ///< axis ON was taken away
    bool referenced_ = false;
    bool measuring_ = false;
    bool stopped_by_condition_ = false;
    bool displaced_ = false;
    std::uint16_t fault_ = 0;
    std::uint16_t raised_ = 0;
    bool changed_ = false;

    bool held_ = false;
    bool limit_positive_ = false, limit_negative_ = false;
    bool home_forced_ = false;
    bool power_pack_ = true;
    bool encoder_broken_ = false;
    double temperature_ = 35;
    double load_ = 0;  ///< 0..1: the lag of a moving axis, 1 ms of its way at full load
};

}  // namespace axisgate::pacontrol::twin
