// One axis of the twin: its power, reference and measuring mode, put together from its shaft, its switches and its traverse task.
// In: commands, parameters, outside conditions. Out: status, errors, what is to be kept.
// Never knows of operating modes or of other axes, and never moves anything but by hand and by the measuring mode's synchronisation.
#pragma once

#include <utility>

#include "adapters/pacontrol/twin/shown.hpp"

namespace axisgate::pacontrol::twin {

class Axis {
public:
    Axis(const AxisModel& model, const AxisParameters& parameters) : model_(model), p_(parameters) {}
    Axis(const Axis&) = delete;
    Axis& operator=(const Axis&) = delete;

    [[nodiscard]] const Shaft& shaft() const noexcept { return shaft_; }
    [[nodiscard]] const Switches& switches() const noexcept { return switches_; }
    [[nodiscard]] const AxisState& state() const noexcept { return state_; }
    [[nodiscard]] const Traverse& traverse() const noexcept { return traverse_; }
    [[nodiscard]] Traverse& traverse() noexcept { return traverse_; }
    [[nodiscard]] bool running() const noexcept { return shaft_.running(); }
    /// 0 in position, 1 moving, 2 stopped, 4 malfunction, 8 measuring mode [L2960].
    [[nodiscard]] std::uint8_t status() const noexcept;
    /// What the commands tell of it.
    [[nodiscard]] const AxisShown& shown() const noexcept { return shown_; }
    [[nodiscard]] const AxisModel& model() const noexcept { return model_; }
    [[nodiscard]] const AxisParameters& parameters() const noexcept { return p_; }
    void set_parameter(std::size_t number, float value) noexcept { p_.at(number) = value; }

    // --- position and reference ---
    void set_referenced(bool on) noexcept;
    void set_position_g26(double x, bool reference) noexcept;
    void set_position_g29(double x) noexcept;
    void delete_g29() noexcept;

    // --- time ---
    /// Everything that is due by `t`; the deadline of its traverse is never passed over.
    void advance(Instant t);
    /// After anything of it may have changed at `t`.
    void settle(Instant t) { shown_.settle(t); }

    // --- power and measuring ---
    /// 0, or a command error. `go_on`: an interrupted traverse goes on by the switch-on mode; false while the control is stopped.
    [[nodiscard]] std::uint16_t switch_on(Instant t, bool go_on);
    void switch_off(Instant t);
    /// G140 (true) / G141: motor without power.
    void disable(bool disabled, Instant t);
    [[nodiscard]] std::uint16_t begin_measuring();
    [[nodiscard]] std::uint16_t end_measuring();
    void set_fault(std::uint16_t number, Instant t);
    void clear_fault() noexcept { state_.fault = 0; }
    void clear_displaced() noexcept { state_.displaced = false; }

    /// A system error that came up by itself since the last call, or 0.
    [[nodiscard]] std::uint16_t take_error() noexcept { return std::exchange(state_.raised, std::uint16_t{0}); }
    /// The rest position, the counter or the reference flag changed: something to keep.
    [[nodiscard]] bool take_changed() noexcept { return std::exchange(state_.changed, false); }

    // --- the tester's hand ---
    void hold(bool held, Instant t);
    void set_limit(bool positive, bool actuated, Instant t);
    void set_home_switch(bool active, Instant t);
    void set_following_error(double ae, Instant t);
    void set_power_pack(bool ready, Instant t);
    void set_load(double share) noexcept { shaft_.set_load(share); }
    /// Temperature and encoder; the power pack has its own.
    [[nodiscard]] AxisOutside& outside() noexcept { return state_.outside; }
    /// False: the motor holds the shaft. Without `supply` anybody can push it; an absolute system sees it at the next power on.
    [[nodiscard]] bool push_to(double ae, bool supply, Instant t);

    // --- memory ---
    struct Kept {
        double position = 0, shaft = 0, shift = 0;
        bool referenced = false;
    };
    [[nodiscard]] Kept kept() const noexcept { return {shaft_.rest(), shaft_.rest_place(), state_.shift, state_.referenced}; }
    /// Power off: stands where it is.
    void lose_power(Instant t);
    /// Power on. With an absolute system position and reference come back, without it the counter begins at 0, unreferenced.
    void boot(const Kept& kept);

private:
    AxisModel model_;
    AxisParameters p_;
    AxisState state_;
    Shaft shaft_{model_.mechanics, model_.seed};
    Switches switches_{model_, p_, shaft_};
    Traverse traverse_{model_, p_, state_, shaft_, switches_};
    AxisShown shown_{model_, state_, shaft_, traverse_};
};

}  // namespace axisgate::pacontrol::twin
