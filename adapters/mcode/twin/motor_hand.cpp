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
constexpr std::array cam_names{"limit_negative_position", "limit_positive_position", "home_position"};
struct SwitchName {
    const char* name;
    InputType type;
};
constexpr std::array switch_names{SwitchName{"limit_positive", InputType::limit_plus}, SwitchName{"limit_negative", InputType::limit_minus},
                                  SwitchName{"home_switch", InputType::home}};

}  // namespace

std::vector<HandItem> Motor::hand(Instant asked) const {
    const Instant now = std::max(asked, last_);
    std::vector<HandItem> items;
    items.push_back({"stall", course_.touch.held, true,
                     "the shaft is held: lost steps without encoder, error 86 with EE=1, lag and then locked rotor with AS=1..3"});
    items.push_back({"load", course_.touch.load, true,
                     "0..1 of the full torque; above the present current (RC, or TQ with AS=3) the moving shaft stops"});
    items.push_back(
        {"position", std::llround(p_.shaft.rotor(now).position), true, "shaft position in the unit of P; can be turned at rest"});
    items.push_back({"inputs", std::int64_t{p_.inputs.levels()}, true, "levels of the inputs, bit 0 = input 1; 1 is 5 to 24 V or open"});
    items.push_back({"active_inputs", std::int64_t{p_.inputs.active_mask()}, true,
                     "switches at the inputs, bit 0 = input 1; 1 is active, whatever level IS makes that"});
    for (const auto& s : switch_names) {
        // A switch beside the axis has a state of its own, also while no input is of its type.
        const auto cam = static_cast<std::size_t>(std::ranges::find(Cams::types, s.type) - Cams::types.begin());
        items.push_back({s.name, p_.inputs.with_type(s.type) || !p_.cams.place(cam) ? p_.inputs.active(s.type) : p_.cams.active(cam, now),
                         true, "the input that IS has given type " + std::to_string(static_cast<int>(s.type)) + " becomes active"});
    }
    for (std::size_t i = 0; i < cam_names.size(); ++i) {
        const auto turns = p_.cams.place(i);
        items.push_back({cam_names[i], turns ? Value{*turns} : Value{std::string("none")}, true,
                         "turn of the shaft where this switch begins, counted from power-up of the model; none: no switch"});
    }
    items.push_back({"analog", std::llround(p_.inputs.analog_raw()), true, "analog input in counts, 0..4095"});
    items.push_back({"analog_signal", 0.0, true, "writing: V (mA with IS=5,10), converted to counts as IS says"});
    items.push_back({"clock_pulses", clock_pulses_, true, "writing: pulses that come at inputs 3 and 4; reading: how many have come"});
    items.push_back({"temperature", p_.power.supply.bridge, true, "of the bridge, deg C: above WT error 71, from 85 error 72"});
    items.push_back({"controller_temperature", p_.power.supply.controller, true, "deg C"});
    items.push_back({"supply_voltage", p_.power.supply.plus_v, true, "+V in V; 10..60 is good"});
    if (p_.power.supply.has_aux) items.push_back({"aux_voltage", p_.power.supply.aux, true, "in V; 10..30 is good, 0 unused"});
    items.push_back(
        {"encoder_fault", std::int64_t{course_.touch.encoder}, true, "what SC 1 finds: 0 nothing, 1 resolution, 2 direction, 3 both"});
    if (p_.settings.is(lmd))
        items.push_back({"output_fault", std::int64_t{output_fault_}, true, "over-current: bit 0 output 1, bit 1 output 2"});
    if (p_.settings.is(lmm))
        items.push_back({"enable_input", p_.power.enable_input, true, "hardware enable of the module; off is error 14"});
    std::int64_t outputs = 0;
    for (std::size_t i = 0; i < output_count; ++i)
        outputs |= p_.outputs.fitted(i) && output(i, now) ? std::int64_t{1} << i : 0;
    items.push_back({"outputs", outputs, false, "outputs that are active, bit 0 = output 1"});
    items.push_back({"current", std::int64_t{course_.current(now)}, false, "percent"});
    items.push_back({"trip_pulses", p_.trips.pulses(), false, "pulses that output 3 of type 28 has given"});
    return items;
}

std::optional<std::string> Motor::set_hand(const std::string& name, const Value& value, Instant now) {
    advance(now);
    const std::string shown = axisgate::to_text(value);
    const auto flag = as_flag(value);
    const auto mask = as_integer(value);
    const auto number = as_number(value);
    Power& power = p_.power;
    const std::string want_flag = name + ": " + shown + " is not true or false";

    for (const Figure& f : figures) {
        if (name == f.name && (!number || !(*number >= f.low && *number <= f.high)))
            return name + ": " + shown + " is not " + axisgate::to_text(Value{f.low}) + " to " + axisgate::to_text(Value{f.high}) + ", " +
                   f.unit;
    }
    for (std::size_t i = 0; i < cam_names.size(); ++i) {
        if (name != cam_names[i]) continue;
        const bool none = !number || !std::isfinite(*number);
        if (none && shown != "none") return name + ": " + shown + " is not a number of turns, or none";
        p_.cams.place(i, none ? std::nullopt : number, now);
        replan(now);
        return "";
    }
    for (const auto& s : switch_names) {
        if (name != s.name) continue;
        if (!flag) return want_flag;
        if (!p_.inputs.drive(s.type, *flag, now)) {
            const std::string type = std::to_string(static_cast<int>(s.type));
            return name + ": no input is of type " + type + "; IS=1," + type + ",0 makes input 1 one";
        }
        replan(now);
        advance(now);
        return "";
    }
    if (name == "stall") {
        if (!flag) return want_flag;
        course_.touch.held = *flag;
        course_.judge_rotor(now);
    } else if (name == "load") {
        course_.touch.load = *number;
        course_.judge_rotor(now);
    } else if (name == "position") {
        if (course_.steps()) return "position: the motor is moving; the shaft can be turned at rest";
        course_.turn_to(*number, now);
    } else if (name == "inputs" || name == "active_inputs") {
        const std::int64_t top = (std::int64_t{1} << p_.inputs.fitted()) - 1;
        if (!mask || *mask < 0 || *mask > top) return name + ": " + shown + " is not 0.." + std::to_string(top) + " (bit 0 = input 1)";
        if (name == "inputs") {
            p_.inputs.levels(static_cast<std::uint8_t>(*mask), now);
        } else {
            p_.inputs.switches(static_cast<std::uint8_t>(*mask), now);
        }
    } else if (name == "analog") {
        p_.inputs.analog_counts(*number, now);
    } else if (name == "analog_signal") {
        p_.inputs.analog_signal(*number, now);
    } else if (name == "clock_pulses") {
        clock_pulses_ += static_cast<std::int64_t>(*number);
        moves_.follow(std::trunc(*number), now);
    } else if (name == "temperature" || name == "controller_temperature") {
        (name == "temperature" ? p_.power.supply.bridge : p_.power.supply.controller) = *number;
        judge_supply(now);
    } else if (name == "supply_voltage") {
        power.supply.plus_v = *number;
        judge_supply(now);
    } else if (name == "aux_voltage" && p_.power.supply.has_aux) {
        power.supply.aux = *number;
        judge_supply(now);
    } else if (name == "encoder_fault") {
        if (!mask || *mask < 0 || *mask > 3) return "encoder_fault: " + shown + " is not 0..3";
        course_.touch.encoder = static_cast<int>(*mask);
    } else if (name == "output_fault" && p_.settings.is(lmd)) {
        if (!mask || *mask < 0 || *mask > 3) return "output_fault: " + shown + " is not 0..3 (bit 0: output 1, bit 1: output 2)";
        for (int n = 0; n < 2; ++n) {
            if ((*mask & ~std::int64_t{output_fault_}) >> n & 1) p_.events.raise(n + 1);
        }
        output_fault_ = static_cast<int>(*mask);
    } else if (name == "enable_input" && p_.settings.is(lmm)) {
        if (!flag) return want_flag;
        if (power.enable_input && !*flag) {
            p_.events.raise(err::lmm_disabled);
            bridges_off(now);
        }
        power.enable_input = *flag;
        power.off = !power.enable_input || (p_.loop.locked() && p_.settings.hmt_mode() != 3);
    } else if (name == "outputs" || name == "current" || name == "trip_pulses") {
        return name + " can only be read";
    } else {
        return std::nullopt;
    }
    replan(now);
    advance(now);
    return "";
}

}  // namespace axisgate::mcode::twin
