// Motor: the tester's hand: shaft, load, inputs, switches beside the axis, analog signal, supplies, temperature.
// In: names and values. Out: what they cause, or why they make no sense.
// Never writes a word of the drive.
#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/motor.hpp"

namespace axisgate::mcode::twin {
namespace {
struct Figure {
    const char* name;
    double low, high;
    const char* unit;
};
constexpr std::array figures{Figure{"load", 0, 1, "part of the full torque"},
                             Figure{"temperature", -40, 150, "deg C"},
                             Figure{"controller_temperature", -40, 150, "deg C"},
                             Figure{"supply_voltage", 0, 100, "V"},
                             Figure{"aux_voltage", 0, 100, "V"},
                             Figure{"analog", 0, analog_full, "counts"},
                             Figure{"analog_signal", 0, 24, "V or mA"},
                             Figure{"position", -2147483648.0, 2147483647.0, "unit of P"},
                             Figure{"clock_pulses", -1e9, 1e9, "pulses"}};
/// In the order of Cams.
constexpr std::array<std::string_view, 3> cam_names{"limit_negative_position", "limit_positive_position", "home_position"};

/// A switch beside the axis has a state of its own, also while no input is of its type.
Value switch_state(const Parts& p, InputType type, Instant now) {
    const auto cam = static_cast<std::size_t>(std::ranges::find(Cams::types, type) - Cams::types.begin());
    return p.inputs.with_type(type) || !p.cams.place(cam) ? p.inputs.active(type) : p.cams.active(cam, now);
}

std::string set_switch(Parts& p, InputType type, const HandWish& w) {
    return w.flag([&](bool on) -> std::string {
        if (p.inputs.drive(type, on, w.now)) return {};
        const std::string number = std::to_string(static_cast<int>(type));
        return w.name + ": no input is of type " + number + "; IS=1," + number + ",0 makes input 1 one";
    });
}

Value cam_place(const Parts& p, std::size_t cam) {
    const auto turns = p.cams.place(cam);
    return turns ? Value{*turns} : Value{std::string("none")};
}

std::string set_cam(Parts& p, std::size_t cam, const HandWish& w) {
    const auto turns = as_number(w.value);
    const bool none = !turns || !std::isfinite(*turns);
    if (none && axisgate::to_text(w.value) != "none") return w.is_not("a number of turns, or none");
    p.cams.place(cam, none ? std::nullopt : turns, w.now);
    return {};
}

template <class Set>
std::string set_mask(const Inputs& inputs, const HandWish& w, Set&& set) {
    const std::int64_t top = (std::int64_t{1} << inputs.fitted()) - 1;
    return w.whole(0, top, "0.." + std::to_string(top) + " (bit 0 = input 1)",
                   [&](std::int64_t mask) { set(static_cast<std::uint8_t>(mask)); });
}

constexpr const char* cam_text = "turn of the shaft where this switch begins, counted from power-up of the model; none: no switch";

/// What a figure is; its range has been looked at.
double figure(const HandWish& w) { return *as_number(w.value); }

std::string only_read(Motor&, const HandWish& w) { return w.name + " can only be read"; }

}  // namespace

const HandRow<Motor> Motor::conditions[] = {
    {"stall", true, "the shaft is held: lost steps without encoder, error 86 with EE=1, lag and then locked rotor with AS=1..3",
     [](const Motor& m, Instant) -> Value { return m.course_.touch.held; },
     [](Motor& m, const HandWish& w) {
         return w.flag([&](bool on) {
             m.course_.touch.held = on;
             m.course_.judge_rotor(w.now);
         });
     }},
    {"load", true, "0..1 of the full torque; above the present current (RC, or TQ with AS=3) the moving shaft stops",
     [](const Motor& m, Instant) -> Value { return m.course_.touch.load; },
     [](Motor& m, const HandWish& w) {
         m.course_.touch.load = figure(w);
         m.course_.judge_rotor(w.now);
         return std::string();
     }},
    {"position", true, "shaft position in the unit of P; can be turned at rest",
     [](const Motor& m, Instant now) -> Value { return std::llround(m.p_.shaft.rotor(now).position); },
     [](Motor& m, const HandWish& w) -> std::string {
         if (m.course_.steps()) return "position: the motor is moving; the shaft can be turned at rest";
         m.course_.turn_to(figure(w), w.now);
         return {};
     }},
    {"inputs", true, "levels of the inputs, bit 0 = input 1; 1 is 5 to 24 V or open",
     [](const Motor& m, Instant) -> Value { return std::int64_t{m.p_.inputs.levels()}; },
     [](Motor& m, const HandWish& w) {
         return set_mask(m.p_.inputs, w, [&](std::uint8_t mask) { m.p_.inputs.levels(mask, w.now); });
     }},
    {"active_inputs", true, "switches at the inputs, bit 0 = input 1; 1 is active, whatever level IS makes that",
     [](const Motor& m, Instant) -> Value { return std::int64_t{m.p_.inputs.active_mask()}; },
     [](Motor& m, const HandWish& w) {
         return set_mask(m.p_.inputs, w, [&](std::uint8_t mask) { m.p_.inputs.switches(mask, w.now); });
     }},
    {"limit_positive", true, "the input that IS has given type 2 becomes active",
     [](const Motor& m, Instant now) { return switch_state(m.p_, InputType::limit_plus, now); },
     [](Motor& m, const HandWish& w) { return set_switch(m.p_, InputType::limit_plus, w); }},
    {"limit_negative", true, "the input that IS has given type 3 becomes active",
     [](const Motor& m, Instant now) { return switch_state(m.p_, InputType::limit_minus, now); },
     [](Motor& m, const HandWish& w) { return set_switch(m.p_, InputType::limit_minus, w); }},
    {"home_switch", true, "the input that IS has given type 1 becomes active",
     [](const Motor& m, Instant now) { return switch_state(m.p_, InputType::home, now); },
     [](Motor& m, const HandWish& w) { return set_switch(m.p_, InputType::home, w); }},
    {cam_names[0], true, cam_text, [](const Motor& m, Instant) { return cam_place(m.p_, 0); },
     [](Motor& m, const HandWish& w) { return set_cam(m.p_, 0, w); }},
    {cam_names[1], true, cam_text, [](const Motor& m, Instant) { return cam_place(m.p_, 1); },
     [](Motor& m, const HandWish& w) { return set_cam(m.p_, 1, w); }},
    {cam_names[2], true, cam_text, [](const Motor& m, Instant) { return cam_place(m.p_, 2); },
     [](Motor& m, const HandWish& w) { return set_cam(m.p_, 2, w); }},
    {"analog", true, "analog input in counts, 0..4095",
     [](const Motor& m, Instant) -> Value { return std::llround(m.p_.inputs.analog_raw()); },
     [](Motor& m, const HandWish& w) { return m.p_.inputs.analog_counts(figure(w), w.now), std::string(); }},
    {"analog_signal", true, "writing: V (mA with IS=5,10), converted to counts as IS says",
     [](const Motor&, Instant) -> Value { return 0.0; },
     [](Motor& m, const HandWish& w) { return m.p_.inputs.analog_signal(figure(w), w.now), std::string(); }},
    {"clock_pulses", true, "writing: pulses that come at inputs 3 and 4; reading: how many have come",
     [](const Motor& m, Instant) -> Value { return m.clock_pulses_; },
     [](Motor& m, const HandWish& w) {
         m.clock_pulses_ += static_cast<std::int64_t>(figure(w));
         m.moves_.follow(std::trunc(figure(w)), w.now);
         return std::string();
     }},
    {"temperature", true, "of the bridge, deg C: above WT error 71, from 85 error 72",
     [](const Motor& m, Instant) -> Value { return m.p_.power.supply.bridge; },
     [](Motor& m, const HandWish& w) { return m.set_supply(m.p_.power.supply.bridge, w); }},
    {"controller_temperature", true, "deg C", [](const Motor& m, Instant) -> Value { return m.p_.power.supply.controller; },
     [](Motor& m, const HandWish& w) { return m.set_supply(m.p_.power.supply.controller, w); }},
    {"supply_voltage", true, "+V in V; 10..60 is good", [](const Motor& m, Instant) -> Value { return m.p_.power.supply.plus_v; },
     [](Motor& m, const HandWish& w) { return m.set_supply(m.p_.power.supply.plus_v, w); }},
    {"aux_voltage", true, "in V; 10..30 is good, 0 unused", [](const Motor& m, Instant) -> Value { return m.p_.power.supply.aux; },
     [](Motor& m, const HandWish& w) { return m.set_supply(m.p_.power.supply.aux, w); },
     [](const Motor& m) { return m.p_.power.supply.has_aux; }},
    {"encoder_fault", true, "what SC 1 finds: 0 nothing, 1 resolution, 2 direction, 3 both",
     [](const Motor& m, Instant) -> Value { return std::int64_t{m.course_.touch.encoder}; },
     [](Motor& m, const HandWish& w) {
         return w.whole(0, 3, "0..3", [&](std::int64_t what) { m.course_.touch.encoder = static_cast<int>(what); });
     }},
    {"output_fault", true, "over-current: bit 0 output 1, bit 1 output 2",
     [](const Motor& m, Instant) -> Value { return std::int64_t{m.output_fault_}; },
     [](Motor& m, const HandWish& w) {
         return w.whole(0, 3, "0..3 (bit 0: output 1, bit 1: output 2)", [&](std::int64_t mask) {
             for (int n = 0; n < 2; ++n) {
                 if ((mask & ~std::int64_t{m.output_fault_}) >> n & 1) m.p_.events.raise(n + 1);
             }
             m.output_fault_ = static_cast<int>(mask);
         });
     },
     [](const Motor& m) { return m.p_.settings.is(lmd); }},
    {"enable_input", true, "hardware enable of the module; off is error 14",
     [](const Motor& m, Instant) -> Value { return m.p_.power.enable_input; },
     [](Motor& m, const HandWish& w) {
         return w.flag([&](bool on) {
             Power& power = m.p_.power;
             if (power.enable_input && !on) {
                 m.p_.events.raise(err::lmm_disabled);
                 m.bridges_off(w.now);
             }
             power.enable_input = on;
             power.off = !on || (m.p_.loop.locked() && m.p_.settings.hmt_mode() != 3);
         });
     },
     [](const Motor& m) { return m.p_.settings.is(lmm); }},
    {"outputs", false, "outputs that are active, bit 0 = output 1",
     [](const Motor& m, Instant now) -> Value {
         std::int64_t outputs = 0;
         for (std::size_t i = 0; i < output_count; ++i)
             outputs |= m.p_.outputs.fitted(i) && m.output(i, now) ? std::int64_t{1} << i : 0;
         return outputs;
     },
     only_read},
    {"current", false, "percent", [](const Motor& m, Instant now) -> Value { return std::int64_t{m.course_.current(now)}; }, only_read},
    {"trip_pulses", false, "pulses that output 3 of type 28 has given", [](const Motor& m, Instant) -> Value { return m.p_.trips.pulses(); },
     only_read},
};

std::vector<HandItem> Motor::hand(Instant asked) const { return hand_items(conditions, *this, std::max(asked, last_)); }

std::optional<std::string> Motor::set_hand(const std::string& name, const Value& value, Instant now) {
    advance(now);
    const HandWish wish{name, value, now};
    for (const Figure& f : figures) {
        const auto number = as_number(value);
        if (name == f.name && (!number || !(*number >= f.low && *number <= f.high)))
            return wish.is_not(axisgate::to_text(Value{f.low}) + " to " + axisgate::to_text(Value{f.high}) + ", " + f.unit);
    }
    auto answer = set_hand_row(conditions, *this, *this, wish);
    if (!answer || !answer->empty()) return answer;
    replan(now);
    if (std::ranges::find(cam_names, name) == cam_names.end()) advance(now);
    return answer;
}

/// A voltage or a temperature.
std::string Motor::set_supply(double& into, const HandWish& w) {
    into = figure(w);
    judge_supply(w.now);
    return {};
}

}  // namespace axisgate::mcode::twin
