// The simulated hand: conditions around the drive, with the names that all families use. Parameters of the drive are not written here.
#include <cmath>
#include <string>

#include "adapters/linmot/twin/device.hpp"

namespace axisgate::linmot::twin {
namespace {
/// The value of a wish; set_hand has checked that it is a finite number.
double number(const HandWish& w) { return *as_number(w.value); }
bool is_in(const HandWish& w, double low, double high) { return number(w) >= low && number(w) <= high; }
}  // namespace

const HandRow<Device> Device::conditions[] = {
    {"power", true, "logic supply", [](const Device& d, Instant) -> Value { return d.powered_; },
     [](Device& d, const HandWish& w) { return d.switch_power(number(w) != 0, w.now), std::string(); }},
    {"silent", true, "hears, does not answer", [](const Device& d, Instant) -> Value { return d.silent_; },
     [](Device& d, const HandWish& w) { return d.silent_ = number(w) != 0, std::string(); }},
    {"stall", true, "the slider is held", [](const Device& d, Instant) -> Value { return d.drive_.outside().stall; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::stall, w); }},
    {"position", true, "0.1 um: the slider moved by hand while nothing controls it",
     [](const Device& d, Instant) -> Value { return std::llround(d.drive_.mechanics().position); },
     [](Device& d, const HandWish& w) -> std::string {
         if (!is_in(w, -2e9, 2e9)) return "position takes 0.1 um within -2e9..2e9";
         d.drive_.move_by_hand(number(w), w.now);
         return {};
     }},
    {"inject_error", true, "error code; 0: none", [](const Device& d, Instant) -> Value { return std::int64_t{d.drive_.error_code()}; },
     [](Device& d, const HandWish& w) -> std::string {
         const double n = number(w);
         if (n != 0 && (!is_in(w, 0, 255) || !d.setup_.error_texts.contains(static_cast<std::uint16_t>(n))))
             return "inject_error takes an error code of the catalogue, or 0";
         d.drive_.inject(static_cast<std::uint16_t>(n), w.now);
         d.set_error_count();
         return {};
     }},
    {"inputs", true, "levels of X4, bit 0 is X4.3",
     [](const Device& d, Instant) -> Value { return std::int64_t{d.drive_.outside().x4_inputs}; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::x4_inputs, w); }},
    {"limit_positive", true, "limit switch OUT", [](const Device& d, Instant) -> Value { return d.drive_.outside().limit_out; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::limit_out, w); }},
    {"limit_negative", true, "limit switch IN", [](const Device& d, Instant) -> Value { return d.drive_.outside().limit_in; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::limit_in, w); }},
    {"temperature", true, "controller, deg C",
     [](const Device& d, Instant) -> Value { return static_cast<double>(d.drive_.outside().temperature) / 10; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::temperature, 10, w); }},
    {"sensor", true, "whose temperature that is: 1..8 in the order of 1BC6h..1BCDh; 0: of all",
     [](const Device& d, Instant) -> Value { return d.drive_.outside().sensor; },
     [](Device& d, const HandWish& w) {
         return d.change_outside(w.now, [&](Outside& o) -> std::string {
             if (!is_in(w, 0, 8)) return "sensor takes 0..8";
             o.sensor = std::llround(number(w));
             return {};
         });
     }},
    {"motor_hot", true, "motor temperature sensor", [](const Device& d, Instant) -> Value { return d.drive_.outside().motor_hot; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::motor_hot, w); }},
    {"ptc_1", true, "PTC 1 hot or open", [](const Device& d, Instant) -> Value { return d.drive_.outside().ptc1_hot; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::ptc1_hot, w); }},
    {"ptc_2", true, "PTC 2 hot or open", [](const Device& d, Instant) -> Value { return d.drive_.outside().ptc2_hot; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::ptc2_hot, w); }},
    {"motor_supply", true, "V",
     [](const Device& d, Instant) -> Value { return static_cast<double>(d.drive_.outside().motor_supply) / 100; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::motor_supply, 100, w); }},
    {"logic_supply", true, "V",
     [](const Device& d, Instant) -> Value { return static_cast<double>(d.drive_.outside().logic_supply) / 100; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::logic_supply, 100, w); }},
    {"safe_voltage_enable", true, "input X4.12", [](const Device& d, Instant) -> Value { return d.drive_.outside().safe_voltage_enable; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::safe_voltage_enable, w); }},
    {"trigger", true, "input X4.6", [](const Device& d, Instant) -> Value { return (d.drive_.outside().x4_inputs & 0x08) != 0; },
     [](Device& d, const HandWish& w) {
         (void)d.set_x4(0x08, w);
         d.drive_.trigger(number(w) != 0, w.now);
         return std::string();
     }},
    {"capture", true, "input X4.5: a rising edge captures the position",
     [](const Device& d, Instant) -> Value { return (d.drive_.outside().x4_inputs & 0x04) != 0; },
     [](Device& d, const HandWish& w) {
         if (const bool was = d.set_x4(0x04, w); number(w) != 0 && !was) d.drive_.capture(w.now);
         return std::string();
     }},
    {"analog", true, "X4.4, as a position of 0.1 um", [](const Device& d, Instant) -> Value { return d.drive_.outside().analog; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::analog, 1, w); }},
    {"encoder", true, "edges of the master encoder, four to a period",
     [](const Device& d, Instant) -> Value { return std::llround(d.drive_.encoder_edges()); },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::encoder, 1, w); }},
    {"encoder_speed", true, "edges of the master encoder per second",
     [](const Device& d, Instant) -> Value { return d.drive_.outside().encoder_speed; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::encoder_speed, 1, w); }},
    {"force", true, "measured force, 0.1 N", [](const Device& d, Instant) -> Value { return d.drive_.outside().force; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::force, 1, w); }},
    {"current", true, "demand current, mA", [](const Device& d, Instant) -> Value { return d.drive_.outside().current; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::current, 1, w); }},
    {"lag_ms", true, "the position follows the demand so late", [](const Device& d, Instant) -> Value { return d.drive_.outside().lag_ms; },
     [](Device& d, const HandWish& w) {
         return d.change_outside(w.now, [&](Outside& o) -> std::string {
             if (!is_in(w, 0, 1000)) return "lag_ms takes 0..1000";
             o.lag_ms = number(w);
             return {};
         });
     }},
    {"control_mask", true, "control word bits that a PC tool has taken over",
     [](const Device& d, Instant) -> Value { return std::int64_t{d.drive_.outside().panel_mask}; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::panel_mask, w); }},
    {"control_word", true, "what it sets them to",
     [](const Device& d, Instant) -> Value { return std::int64_t{d.drive_.outside().panel_word}; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::panel_word, w); }},
    {"copy_mask", true, "control word bits that the interface may set",
     [](const Device& d, Instant) -> Value { return std::int64_t{d.drive_.outside().copy_mask}; },
     [](Device& d, const HandWish& w) { return d.set_outside(&Outside::copy_mask, w); }},
};

std::vector<HandItem> Device::hand() const { return hand_items(conditions, *this, Instant{}); }

std::string Device::set_hand(const std::string& name, const Value& value, Instant now, Out& out) {
    advance(now);
    shown_.doubt();
    const auto n = as_number(value);
    if (!n || !std::isfinite(*n)) return name + " takes a number, true or false";
    if (auto answer = set_hand_row(conditions, *this, *this, {name, value, now, &out})) return *std::move(answer);
    return "there is no condition " + name;
}

void Device::switch_power(bool on, Instant now) {
    if (on == powered_) return;
    powered_ = on;
    if (on) {
        deaf_until_ = now;
        start(now);
    } else {
        drive_.stop_software(now);
        reply_at_ = never;
    }
}

template <class Change>
std::string Device::change_outside(Instant now, Change&& change) {
    Outside o = drive_.outside();
    std::string fault = change(o);
    if (fault.empty()) drive_.set_outside(o, now);
    set_error_count();
    return fault;
}

std::string Device::set_outside(bool Outside::*member, const HandWish& w) {
    return change_outside(w.now, [&](Outside& o) { return o.*member = number(w) != 0, std::string(); });
}

std::string Device::set_outside(std::uint16_t Outside::*member, const HandWish& w) {
    return change_outside(w.now, [&](Outside& o) -> std::string {
        if (!is_in(w, 0, 65535)) return w.name + " takes 0..65535";
        o.*member = static_cast<std::uint16_t>(number(w));
        return {};
    });
}

std::string Device::set_outside(std::int64_t Outside::*member, double factor, const HandWish& w) {
    return change_outside(w.now, [&](Outside& o) -> std::string {
        if (!is_in(w, -2e9, 2e9)) return w.name + " is out of range";
        o.*member = std::llround(number(w) * factor);
        return {};
    });
}

/// Sets an input of X4; returns its previous level.
bool Device::set_x4(std::uint16_t bit, const HandWish& w) {
    Outside o = drive_.outside();
    const bool was = (o.x4_inputs & bit) != 0;
    o.x4_inputs = static_cast<std::uint16_t>(number(w) != 0 ? o.x4_inputs | bit : o.x4_inputs & ~bit);
    drive_.set_outside(o, w.now);
    return was;
}

}  // namespace axisgate::linmot::twin
