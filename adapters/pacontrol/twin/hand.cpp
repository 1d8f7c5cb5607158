// The tester's hand: outside conditions of the control, by the names that all families share.
// In: names and values. Out: what they cause, or why they make no sense.
// Never writes an element that belongs to the program: inputs alone are outside.
#include <cmath>

#include "adapters/pacontrol/twin/device.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::pacontrol::twin {
namespace {

constexpr int mask_bits = 32;
constexpr const char* no_power = ": the control has no power";

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

/// A number of an axis' condition.
template <class Then>
std::string within(const HandWish& w, double least, double largest, Then&& then) {
    return w.number(least, largest, "a number from " + to_text(Value{least}) + " to " + to_text(Value{largest}), then);
}

}  // namespace

const HandRow<Device> Device::conditions[] = {
    {"power", true, "supply voltage; off loses outputs, overrides and the operating mode",
     [](const Device& d, Instant) -> Value { return d.powered_; },
     [](Device& d, const HandWish& w) {
         return w.flag([&](bool on) {
             if (on == d.powered_) return;
             d.powered_ = on;
             if (on) {
                 d.reader_.reset();
                 d.deaf_until_ = Instant::min();
                 d.control_.power_on(d.control_.memory(), w.now);
                 d.announced_error_ = d.control_.shown_error();
             } else {
                 d.control_.power_off(w.now);
                 d.waiting_.clear();
             }
         });
     }},
    {"silent", true, "the control hears and acts, but nothing that it sends reaches the line",
     [](const Device& d, Instant) -> Value { return d.silent_; },
     [](Device& d, const HandWish& w) { return w.flag([&](bool on) { d.silent_ = on; }); }},
    {"inputs", true, "levels of I1 (bit 0) to I32 (bit 31)",
     [](const Device& d, Instant) -> Value {
         std::int64_t mask = 0;
         for (int b = 0; b < mask_bits; ++b)
             mask |= std::int64_t{d.control_.signals().elements().inputs.get(b + 1)} << b;
         return mask;
     },
     [](Device& d, const HandWish& w) {
         return w.whole(0, 0xFFFFFFFFll, "0..4294967295 (bit 0: I1)", [&](std::int64_t mask) {
             for (int b = 0; b < mask_bits; ++b)
                 d.control_.set_input(b + 1, ((mask >> b) & 1) != 0, w.now);
         });
     }},
    {"input", true, "one input, I1 to I1024, and its level: I33=1", [](const Device&, Instant) -> Value { return std::string(); },
     [](Device& d, const HandWish& w) -> std::string {
         const auto* text = std::get_if<std::string>(&w.value);
         if (text && text->empty()) return {};  // as it is listed
         const auto equals = text ? text->find('=') : std::string::npos;
         const std::string level = equals == std::string::npos ? "" : text->substr(equals + 1);
         if (equals == std::string::npos || text->front() != 'I' || (level != "0" && level != "1"))
             return w.is_not("an input and its level, such as I33=1");
         return d.set_condition(text->substr(0, equals), Value{level == "1"}, w.now);
     }},
    {"external_stop", true, "the external-stop contact carries power; without it ONLINE cannot start, and what runs is stopped",
     [](const Device& d, Instant) -> Value { return d.control_.signals().external_stop_wire(); },
     [](Device& d, const HandWish& w) { return w.flag([&](bool on) { d.control_.set_external_stop(on, w.now); }); }},
    {"emergency_stop", true, "true: all axes stop, AUTOMATIC and ONLINE end in status 19 or 39",
     [](const Device&, Instant) -> Value { return false; },
     [](Device& d, const HandWish& w) {
         if (!d.powered_) return w.name + no_power;
         return w.flag([&](bool on) {
             if (on) d.control_.operation().emergency_stop(w.now);
         });
     }},
    {"inject_error", true, "PA-CONTROL error number 1..999: 1..99 CPU, 100..499 hardware, 500..999 online/automatic; 0 takes it away",
     [](const Device& d, Instant) -> Value { return std::int64_t{d.control_.error()}; },
     [](Device& d, const HandWish& w) {
         if (!d.powered_) return w.name + no_power;
         return w.whole(0, 999, "a PA-CONTROL error number 0..999",
                        [&](std::int64_t n) { d.control_.operation().raise(static_cast<std::uint16_t>(n), w.now); });
     }},
    {"panel", true, "the operator switches the mode at the control: home, manual, winpac, automatic",
     [](const Device& d, Instant) -> Value { return std::string(name_of(d.control_.status())); },
     [](Device& d, const HandWish& w) {
         if (!d.powered_) return w.name + no_power;
         const auto* text = std::get_if<std::string>(&w.value);
         if (!text) return "panel: " + to_text(w.value) + " is none of home, manual, winpac, automatic";
         return d.control_.operation().panel(*text, w.now);
     }},
    {"program", true, "name of the START program of AUTOMATIC",
     [](const Device& d, Instant) -> Value { return d.control_.programs().chosen().name; },
     [](Device& d, const HandWish& w) -> std::string {
         const auto* text = std::get_if<std::string>(&w.value);
         if (text && d.control_.programs().choose(*text)) return {};
         return "program: there is no program '" + to_text(w.value) + "'; see the option programs";
     }},
};

const HandRow<Axis, Device::AxisHand> Device::axis_conditions[] = {
    {"stall", true, "the shaft is held: the following error grows up to the monitor's limit",
     [](const Axis& a, Instant) -> Value { return a.shaft().held(); },
     [](AxisHand& h, const HandWish& w) { return w.flag([&](bool on) { h.axis.hold(on, w.now); }); }},
    {"limit_positive", true, "positive limit switch actuated, or its cable broken",
     [](const Axis& a, Instant) -> Value { return a.switches().limit_by_hand(true); },
     [](AxisHand& h, const HandWish& w) { return w.flag([&](bool on) { h.axis.set_limit(true, on, w.now); }); }},
    {"limit_negative", true, "negative limit switch actuated, or its cable broken",
     [](const Axis& a, Instant) -> Value { return a.switches().limit_by_hand(false); },
     [](AxisHand& h, const HandWish& w) { return w.flag([&](bool on) { h.axis.set_limit(false, on, w.now); }); }},
    {"home_switch", true, "reference switch held actuated; without it the switch is actuated at shaft positions below 0",
     [](const Axis& a, Instant) -> Value { return a.switches().home_by_hand(); },
     [](AxisHand& h, const HandWish& w) { return w.flag([&](bool on) { h.axis.set_home_switch(on, w.now); }); }},
    {"temperature", true, "deg C, as 1920 tells", [](const Axis& a, Instant) -> Value { return a.state().outside.temperature; },
     [](AxisHand& h, const HandWish& w) { return within(w, -40, 200, [&](double x) { h.axis.outside().temperature = x; }); }},
    {"load", true, "0..1: the axis lags by 1 ms of its way at full load", [](const Axis& a, Instant) -> Value { return a.shaft().load(); },
     [](AxisHand& h, const HandWish& w) { return within(w, 0, 1, [&](double x) { h.axis.set_load(x); }); }},
    {"following_error", true, "0.001 AE, added to the axis' own",
     [](const Axis& a, Instant) -> Value { return a.shaft().extra_lag() * 1000; },
     [](AxisHand& h, const HandWish& w) { return within(w, -1e12, 1e12, [&](double x) { h.axis.set_following_error(x / 1000, w.now); }); }},
    {"power_pack", true, "the power pack is ready", [](const Axis& a, Instant) -> Value { return a.state().outside.power_pack; },
     [](AxisHand& h, const HandWish& w) { return w.flag([&](bool on) { h.axis.set_power_pack(on, w.now); }); }},
    {"encoder_broken", true, "no encoder edges: E560 when measuring ends with synchronisation",
     [](const Axis& a, Instant) -> Value { return a.state().outside.encoder_broken; },
     [](AxisHand& h, const HandWish& w) { return w.flag([&](bool on) { h.axis.outside().encoder_broken = on; }); }},
    {"jog", true, "front panel in manual mode: -1, 1 moves at manual speed, 0 stops",
     [](const Axis&, Instant) -> Value { return std::int64_t{0}; },
     [](AxisHand& h, const HandWish& w) {
         return within(w, -1, 1,
                       [&](double x) { return h.powered([&] { h.device.control_.motions().jog(h.n, static_cast<int>(x), w.now); }, w); });
     }},
    {"position", true, "shaft position, 0.001 AE; can be pushed while the axis is off or in measuring mode",
     [](const Axis& a, Instant at) -> Value { return at == Instant::min() ? 0.0 : std::round(a.shaft().place(at) * 1000); },
     [](AxisHand& h, const HandWish& w) {
         return within(w, -1e12, 1e12, [&](double x) -> std::string {
             if (h.axis.push_to(x / 1000, h.device.powered_, w.now)) return {};
             return "position: the motor holds the shaft; switch the axis off (0A98) or into measuring mode (0AA0)";
         });
     }},
    {"inject_error", true, "error number of this axis, 1..999; 0 takes it away",
     [](const Axis& a, Instant) -> Value { return std::int64_t{a.state().fault}; },
     [](AxisHand& h, const HandWish& w) {
         return within(w, 0, 999, [&](double x) {
             return h.powered([&] { h.device.control_.operation().raise_axis(h.n, static_cast<std::uint16_t>(x), w.now); }, w);
         });
     }},
};

std::vector<HandItem> Device::hand() const {
    std::vector<HandItem> items = hand_items(conditions, *this, last_);
    for (int n = 1; n <= control_.axes(); ++n) {
        const std::string numbered = "axis" + std::to_string(n) + ".";
        for (HandItem& item : hand_items(axis_conditions, control_.axis(n), last_)) {
            // Plain names are those of axis 1, but for what the control has by that name, too.
            if (n > 1 || item.name == "inject_error") item.name = numbered + item.name;
            items.push_back(std::move(item));
        }
    }
    return items;
}

std::string Device::set_hand(const std::string& name, const Value& value, Instant now, Out& out) {
    now = std::max(now, last_);
    pass(now, out);
    const bool was_powered = powered_;
    std::string fault = set_condition(name, value, now);
    control_.settle(now);
    if (powered_ && !was_powered) announce_power(now, out);
    announce_error(now, out);
    return fault;
}

std::string Device::set_condition(const std::string& name, const Value& value, Instant now) {
    const HandWish wish{name, value, now};
    if (auto answer = set_hand_row(conditions, *this, *this, wish)) return *std::move(answer);
    if (name.size() > 1 && name.front() == 'I') {
        const auto n = parse_whole(std::string_view(name).substr(1), 0, INT64_MAX);
        if (!n || !control_.signals().elements().inputs.has(*n)) return "there is no input '" + name + "': I1..I1024";
        return wish.flag([&](bool on) { control_.set_input(*n, on, now); });
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

template <class Then>
std::string Device::AxisHand::powered(Then&& then, const HandWish& w) {
    if (!device.powered_) return w.name + no_power;
    return then(), std::string();
}

std::string Device::set_axis_condition(int n, const std::string& name, const Value& value, Instant now) {
    AxisHand hand{*this, control_.axis(n), n};
    if (auto answer = set_hand_row(axis_conditions, hand.axis, hand, {name, value, now})) return *std::move(answer);
    return "there is no '" + name +
           "' here; power, silent, inputs, input, I1..I1024, external_stop, emergency_stop, inject_error, panel, program, and for each "
           "axis "
           "(plain: "
           "axis 1, else axisN.) stall, limit_positive, limit_negative, home_switch, temperature, load, following_error, power_pack, "
           "encoder_broken, jog, position, inject_error";
}

}  // namespace axisgate::pacontrol::twin
