// The tester's hand: outside conditions of the control, by the names that all families share.
// In: names and values. Out: what they cause, or why they make no sense.
// Never writes an element that belongs to the program: inputs alone are outside.
#include <cmath>

#include "adapters/pacontrol/twin/device.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::pacontrol::twin {
namespace {

constexpr int mask_bits = 32;

const char* name_of(std::uint8_t status) {
    switch (column_of(status)) {
        case gate::manual:
            return status == status::winpac ? "winpac" : "manual";
        case gate::automatic:
            return "automatic";
        case gate::online:
            return "online";
        default:
            return "home";
    }
}

}  // namespace

std::vector<HandItem> Device::hand() const {
    std::vector<HandItem> items;
    std::int64_t mask = 0;
    for (int b = 0; b < mask_bits; ++b)
        mask |= std::int64_t{control_.signals().elements().inputs.get(b + 1)} << b;
    items.push_back({"power", powered_, true, "supply voltage; off loses outputs, overrides and the operating mode"});
    items.push_back({"silent", silent_, true, "the control hears and acts, but nothing that it sends reaches the line"});
    items.push_back({"inputs", mask, true, "levels of I1 (bit 0) to I32 (bit 31)"});
    items.push_back({"input", std::string(), true, "one input, I1 to I1024, and its level: I33=1"});
    items.push_back({"external_stop", control_.signals().external_stop_wire(), true,
                     "the external-stop contact carries power; without it ONLINE cannot start, and what runs is stopped"});
    items.push_back({"emergency_stop", false, true, "true: all axes stop, AUTOMATIC and ONLINE end in status 19 or 39"});
    items.push_back({"inject_error", std::int64_t{control_.error()}, true,
                     "PA-CONTROL error number 1..999: 1..99 CPU, 100..499 hardware, 500..999 online/automatic; 0 takes it away"});
    items.push_back({"panel", std::string(name_of(control_.status())), true,
                     "the operator switches the mode at the control: home, manual, winpac, automatic"});
    items.push_back({"program", control_.programs().chosen().name, true, "name of the START program of AUTOMATIC"});
    for (int n = 1; n <= control_.axes(); ++n) {
        const Axis& a = control_.axis(n);
        const std::string p = n == 1 ? "" : "axis" + std::to_string(n) + ".";
        items.push_back({p + "stall", a.shaft().held(), true, "the shaft is held: the following error grows up to the monitor's limit"});
        items.push_back(
            {p + "limit_positive", a.switches().limit_by_hand(true), true, "positive limit switch actuated, or its cable broken"});
        items.push_back(
            {p + "limit_negative", a.switches().limit_by_hand(false), true, "negative limit switch actuated, or its cable broken"});
        items.push_back({p + "home_switch", a.switches().home_by_hand(), true,
                         "reference switch held actuated; without it the switch is actuated at shaft positions below 0"});
        items.push_back({p + "temperature", a.state().outside.temperature, true, "deg C, as 1920 tells"});
        items.push_back({p + "load", a.shaft().load(), true, "0..1: the axis lags by 1 ms of its way at full load"});
        items.push_back({p + "following_error", a.shaft().extra_lag() * 1000, true, "0.001 AE, added to the axis' own"});
        items.push_back({p + "power_pack", a.state().outside.power_pack, true, "the power pack is ready"});
        items.push_back({p + "encoder_broken", a.state().outside.encoder_broken, true,
                         "no encoder edges: E560 when measuring ends with synchronisation"});
        items.push_back({p + "jog", std::int64_t{0}, true, "front panel in manual mode: -1, 1 moves at manual speed, 0 stops"});
        items.push_back({p + "position", last_ == Instant::min() ? 0.0 : std::round(a.shaft().place(last_) * 1000), true,
                         "shaft position, 0.001 AE; can be pushed while the axis is off or in measuring mode"});
        items.push_back({"axis" + std::to_string(n) + ".inject_error", std::int64_t{a.state().fault}, true,
                         "error number of this axis, 1..999; 0 takes it away"});
    }
    return items;
}

std::string Device::set_hand(const std::string& name, const Value& value, Instant now, Out& out) {
    now = std::max(now, last_);
    pass(now, out);
    std::string fault = set_condition(name, value, now);
    control_.settle(now);
    return fault;
}

std::string Device::set_condition(const std::string& name, const Value& value, Instant now) {
    const auto flag = as_flag(value);
    const auto number = as_integer(value);
    const auto* text = std::get_if<std::string>(&value);
    const std::string want_flag = name + ": " + to_text(value) + " is not true or false";

    if (name == "power") {
        if (!flag) return want_flag;
        if (*flag == powered_) return {};
        if (!*flag) {
            control_.power_off(now);
            powered_ = false;
            waiting_.clear();
            return {};
        }
        powered_ = true;
        reader_.reset();
        control_.power_on(control_.memory(), now);
        return {};
    }
    if (name == "silent") {
        if (!flag) return want_flag;
        silent_ = *flag;
        return {};
    }
    if (name == "inputs") {
        if (!number || *number < 0 || *number > 0xFFFFFFFFll) return "inputs: " + to_text(value) + " is not 0..4294967295 (bit 0: I1)";
        for (int b = 0; b < mask_bits; ++b)
            control_.set_input(b + 1, ((*number >> b) & 1) != 0, now);
        return {};
    }
    if (name == "input") {
        if (text && text->empty()) return {};  // as it is listed
        const auto equals = text ? text->find('=') : std::string::npos;
        const std::string level = equals == std::string::npos ? "" : text->substr(equals + 1);
        if (equals == std::string::npos || text->front() != 'I' || (level != "0" && level != "1"))
            return "input: " + to_text(value) + " is not an input and its level, such as I33=1";
        return set_condition(text->substr(0, equals), Value{level == "1"}, now);
    }
    if (name.size() > 1 && name.front() == 'I') {
        const auto n = parse_whole(std::string_view(name).substr(1), 0, INT64_MAX);
        if (!n || !control_.signals().elements().inputs.has(*n)) return "there is no input '" + name + "': I1..I1024";
        if (!flag) return want_flag;
        control_.set_input(*n, *flag, now);
        return {};
    }
    if (name == "external_stop") {
        if (!flag) return want_flag;
        control_.set_external_stop(*flag, now);
        return {};
    }
    if (name == "program") {
        if (!text || !control_.programs().choose(*text))
            return "program: there is no program '" + to_text(value) + "'; see the option programs";
        return {};
    }
    const bool needs_power = name == "emergency_stop" || name == "inject_error" || name == "panel";
    if (needs_power && !powered_) return name + ": the control has no power";
    if (name == "emergency_stop") {
        if (!flag) return want_flag;
        if (*flag) control_.operation().emergency_stop(now);
        return {};
    }
    if (name == "inject_error") {
        if (!number || *number < 0 || *number > 999) return "inject_error: " + to_text(value) + " is not a PA-CONTROL error number 0..999";
        control_.operation().raise(static_cast<std::uint16_t>(*number), now);
        return {};
    }
    if (name == "panel") {
        if (!text) return "panel: " + to_text(value) + " is none of home, manual, winpac, automatic";
        return control_.operation().panel(*text, now);
    }
    if (name.starts_with("axis")) {
        const auto dot = name.find('.');
        const auto n = dot == std::string::npos ? std::nullopt : parse_whole(std::string_view(name).substr(4, dot - 4), 0, INT64_MAX);
        if (!n || *n < 1 || *n > control_.axes())
            return "there is no '" + name + "' here; axes are axis1 to axis" + std::to_string(control_.axes());
        return set_axis_condition(static_cast<int>(*n), name.substr(dot + 1), value, now);
    }
    return set_axis_condition(1, name, value, now);
}

std::string Device::set_axis_condition(int n, const std::string& name, const Value& value, Instant now) {
    Axis& a = control_.axis(n);
    const auto flag = as_flag(value);
    const auto number = as_number(value);
    const std::string want_flag = name + ": " + to_text(value) + " is not true or false";

    const bool is_flag = name == "stall" || name == "limit_positive" || name == "limit_negative" || name == "home_switch" ||
                         name == "power_pack" || name == "encoder_broken";
    if (is_flag) {
        if (!flag) return want_flag;
        if (name == "stall") {
            a.hold(*flag, now);
        } else if (name == "limit_positive" || name == "limit_negative") {
            a.set_limit(name == "limit_positive", *flag, now);
        } else if (name == "home_switch") {
            a.set_home_switch(*flag, now);
        } else if (name == "power_pack") {
            a.set_power_pack(*flag, now);
        } else {
            a.set_encoder_broken(*flag);
        }
        return {};
    }
    struct Range {
        const char* name;
        double least, largest;
    };
    constexpr std::array<Range, 6> ranges{{{"temperature", -40, 200},
                                           {"load", 0, 1},
                                           {"following_error", -1e12, 1e12},
                                           {"jog", -1, 1},
                                           {"position", -1e12, 1e12},
                                           {"inject_error", 0, 999}}};
    for (const Range& r : ranges) {
        if (name != r.name) continue;
        if (!number || !(*number >= r.least && *number <= r.largest)) {
            return name + ": " + to_text(value) + " is not a number from " + to_text(Value{r.least}) + " to " + to_text(Value{r.largest});
        }
        if (name == "temperature") {
            a.set_temperature(*number);
        } else if (name == "load") {
            a.set_load(*number);
        } else if (name == "following_error") {
            a.set_following_error(*number / 1000, now);
        } else if (name == "position") {
            if (!powered_ ? !a.push_unpowered(*number / 1000) : !a.push_to(*number / 1000, now))
                return "position: the motor holds the shaft; switch the axis off (0A98) or into measuring mode (0AA0)";
        } else if (!powered_) {
            return name + ": the control has no power";
        } else if (name == "jog") {
            control_.motions().jog(n, static_cast<int>(*number), now);
        } else {
            control_.operation().raise_axis(n, static_cast<std::uint16_t>(*number), now);
        }
        return {};
    }
    return "there is no '" + name +
           "' here; power, silent, inputs, input, I1..I1024, external_stop, emergency_stop, inject_error, panel, program, and for each "
           "axis "
           "(plain: "
           "axis 1, else axisN.) stall, limit_positive, limit_negative, home_switch, temperature, load, following_error, power_pack, "
           "encoder_broken, jog, position, inject_error";
}

}  // namespace axisgate::pacontrol::twin
