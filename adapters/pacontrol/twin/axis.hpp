// One axis of the twin: its power, reference and measuring mode, put together from its shaft, its switches and its traverse task.
// In: commands, parameters, outside conditions. Out: status, errors, what is to be kept.
// Never knows of operating modes or of other axes, and never moves anything but by hand and by the measuring mode's synchronisation.
#pragma once

#include <utility>

#include "adapters/pacontrol/twin/shown.hpp"
#include "adapters/pacontrol/twin/traverse.hpp"

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
    /// The status, and whether it runs, as the commands tell; as of the last `settle`.
    struct Shown {
        std::uint8_t status = 0;
        bool running = false;
        bool operator==(const Shown&) const = default;
    };
    [[nodiscard]] Shown shown() const noexcept { return shown_.delays() ? shown_.shown() : telling(); }
    /// The position as the commands tell it.
    [[nodiscard]] double shown_position(Instant t) const noexcept { return position_.samples() ? position_.value() : own_position(t); }
    [[nodiscard]] const AxisModel& model() const noexcept { return model_; }
    [[nodiscard]] const AxisParameters& parameters() const noexcept { return p_; }
    void set_parameter(std::size_t number, float value) noexcept { p_.at(number) = value; }

    // --- position and reference ---
    void set_referenced(bool on) noexcept;
    void set_position_g26(double x, bool reference) noexcept;
    void set_position_g29(double x) noexcept;
    void delete_g29() noexcept;

    // --- time ---
    /// Everything that is due by `t`; a deadline of its own is never passed over.
    void advance(Instant t);
    [[nodiscard]] Instant deadline() const noexcept { return std::min(traverse_.deadline(), on_at_); }
    /// After anything of it may have changed at `t`.
    void settle(Instant t) { shown_.follow(telling(), t); }

    // --- power and measuring ---
    /// 0, or a command error. `go_on`: an interrupted traverse goes on by the switch-on mode; false while the control is stopped.
    [[nodiscard]] std::uint16_t switch_on(Instant t, bool go_on);
    /// 0A97 was acknowledged, and it is not on yet.
    [[nodiscard]] bool switching_on() const noexcept { return on_at_ != never; }
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
    void set_temperature(double celsius) noexcept { state_.outside.temperature = celsius; }
    void set_encoder_broken(bool broken) noexcept { state_.outside.encoder_broken = broken; }
    /// False: the motor holds the shaft.
    [[nodiscard]] bool push_to(double ae, Instant t);
    /// Without supply anybody can push it; an absolute system sees it at the next power on.
    bool push_unpowered(double ae) noexcept;

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
    [[nodiscard]] Shown telling() const noexcept;
    [[nodiscard]] double own_position(Instant t) const noexcept {
        return model_.measured_position ? shaft_.encoder(t) : shaft_.position(t);
    }
    std::uint16_t now_on(Instant t, bool go_on);

    AxisModel model_;
    AxisParameters p_;
    AxisState state_;
    Shaft shaft_{model_.mechanics, model_.seed};
    Switches switches_{model_, p_, shaft_};
    Traverse traverse_{model_, p_, state_, shaft_, switches_};
    Delayed<Shown> shown_{model_.status_behind};
    Sampled position_{model_.position_every};
    Instant on_at_ = never;    ///< when it is on ...
    bool on_goes_on_ = false;  ///< ... and whether an interrupted traverse goes on then
};

}  // namespace axisgate::pacontrol::twin
