// The tester's hand: outside conditions of the drive, by the names that all families share.
// In: names and values. Out: what they cause on the wire, or why they make no sense.
// Never writes a register, but for the bit rate that a service tool would set back.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "adapters/uim342/twin/device.hpp"

namespace axisgate::uim342::twin {
namespace {

bool known_alarm(std::int64_t code) {
    switch (code) {
        case 0x0A:
        case 0x19:
        case 0x1A:
        case 0x1B:
        case 0x1D:
        case 0x1E:
        case 0x1F:
            return true;
        default:
            return false;
    }
}

/// Where a machine would have them: the drive knows inputs alone, and IL[0..2] say what a change of each does.
struct Switch {
    std::string_view name;
    unsigned bit;
    std::string_view text;
};
constexpr std::array switches{Switch{"home_switch", 0, "a switch at IN1 (bit 0 of inputs), true: high; IL[0] says what the drive does"},
                              Switch{"limit_positive", 1, "a switch at IN2 (bit 1 of inputs), true: high; IL[1] says what the drive does"},
                              Switch{"limit_negative", 2, "a switch at IN3 (bit 2 of inputs), true: high; IL[2] says what the drive does"}};

}  // namespace

std::vector<HandItem> Device::hand() const {
    std::vector<HandItem> items;
    items.push_back({"power", powered_, true, "supply voltage; off loses everything that is not in FLASH or EEPROM"});
    items.push_back({"silent", link_.silent, true, "the drive hears and acts, but nothing that it sends reaches the line"});
    items.push_back({"stall", axis_.held(), true,
                     "the shaft is held; in closed loop (IC[6] = 1) the drive detects it after QE[1] pulses, in open loop never"});
    items.push_back({"inputs", std::int64_t{inputs_.applied()}, true,
                     "levels of IN1 (bit 0), IN2 (bit 1), IN3 (bit 2), sampled each ms. Limit and home switches are wired here: the drive "
                     "has no input of its own for them, IL[0..2] say what a level change does"});
    for (const Switch& x : switches)
        items.push_back({std::string(x.name), ((inputs_.applied() >> x.bit) & 1u) != 0, true, std::string(x.text)});
    items.push_back({"temperature", temperature_, true,
                     "of the motor, deg C; nothing follows from it: the manual gives the drive neither a reading nor an alarm of it"});
    items.push_back({"inject_error", static_cast<std::int64_t>(injected_), true,
                     "an alarm: 10 emergency stop and lock, 25 overspeed, 26 lower limit, 27 upper limit, 29 stall, 30 encoder error, "
                     "31 battery low; sent once, 0 ends the condition"});
    items.push_back(
        {"lost_pulses", axis_.lost(), true,
         "writing adds pulses that the motor did not follow, 0 forgets them; reading: lost since the last start (closed loop)"});
    items.push_back({"encoder_error", encoder_error_, true, "the encoder is broken: alarm 1E, at power-on too"});
    items.push_back({"battery_low", battery_low_, true, "battery of the absolute encoder: alarm 1F, QE[3] = 0"});
    const bool ever = last_ != Instant::min();
    items.push_back({"position", ever ? std::int64_t{wrap_i32(axis_.shaft(last_).position)} : std::int64_t{0}, true,
                     "shaft position, pulses; can be turned by hand while the driver is off"});
    items.push_back({"shaft_turns", ever ? axis_.turns(last_) : 0.0, false,
                     "turns of the shaft, counter-clockwise positive: what MT[0], QE[0], QE[2], QE[4] and IC[1] make of the pulses"});
    if (link_.bus_rate) {
        items.push_back({"bit_rate_code", std::int64_t{link_.bit_rate}, true,
                         "bit rate of the CAN line that the drive hears, as a code of PP[5]; writing sets PP[5] and acts at once, as a "
                         "service tool at the drive would: the way back after a wrong PP[5]"});
    }
    return items;
}

std::string Device::set_hand(const std::string& name, const Value& value, Instant now, Out& out) {
    now = std::max(now, last_);
    settle(now, out);
    std::string fault = set_condition(name, value, now, out);
    settle(now, out);
    return fault;
}

std::string Device::set_condition(const std::string& name, const Value& value, Instant now, Out& out) {
    const auto flag = as_flag(value);
    const auto number = as_integer(value);
    const std::string want_flag = name + ": " + to_text(value) + " is not true or false";

    if (name == "power") {
        if (!flag) return want_flag;
        if (*flag == powered_) return {};
        if (!*flag) {
            power_off(now);
            return {};
        }
        powered_ = true;
        boot(now, axis_.position(now));
        return {};
    }
    if (name == "silent") {
        if (!flag) return want_flag;
        link_.silent = *flag;
        return {};
    }
    if (name == "stall") {
        if (!flag) return want_flag;
        on_axis(axis_.hold(*flag, now), now, out);
        return {};
    }
    if (name == "inputs") {
        if (!number || *number < 0 || *number > 7) return "inputs: " + to_text(value) + " is not 0..7 (bit 0: IN1, bit 1: IN2, bit 2: IN3)";
        inputs_.apply(static_cast<std::uint8_t>(*number), now);
        return {};
    }
    for (const Switch& x : switches) {
        if (name != x.name) continue;
        if (!flag) return want_flag;
        const unsigned rest = inputs_.applied() & ~(1u << x.bit);
        inputs_.apply(static_cast<std::uint8_t>(*flag ? rest | 1u << x.bit : rest), now);
        return {};
    }
    if (name == "temperature") {
        const auto degrees = as_number(value);
        if (!degrees || !(*degrees >= -50 && *degrees <= 200)) return "temperature: " + to_text(value) + " is not -50..200 deg C";
        temperature_ = *degrees;
        return {};
    }
    if (name == "inject_error") {
        if (!number || (*number != 0 && !known_alarm(*number)))
            return "inject_error: " + to_text(value) +
                   " is not an alarm of this drive; 10, 25, 26, 27, 29, 30, 31 (hex 0A 19 1A 1B 1D 1E 1F), 0 ends it";
        return inject(*number, now, out);
    }
    if (name == "lost_pulses") {
        if (!number || *number < 0 || *number > 1'000'000) return "lost_pulses: " + to_text(value) + " is not 0..1000000";
        if (*number == 0) {
            axis_.forget_lost(now);
        } else if (!axis_.driver_on()) {
            return "lost_pulses: the driver is off, so no pulses are sent and none can be lost; switch it on first (MO=1)";
        } else {
            on_axis(axis_.lose(*number, now), now, out);
        }
        return {};
    }
    if (name == "encoder_error" || name == "battery_low") {
        if (!flag) return want_flag;
        bool& condition = name == "encoder_error" ? encoder_error_ : battery_low_;
        if (*flag && !condition && online_) raise(name == "encoder_error" ? Alarm::encoder_error : Alarm::battery_low, now, out);
        condition = *flag;
        return {};
    }
    if (name == "position") {
        const auto there = as_number(value);
        if (!there || !(std::abs(*there) <= 2147483647.0))
            return "position: " + to_text(value) + " is not a position of 32 bits, in pulses";
        if (axis_.driver_on()) return "position: the driver holds the shaft; switch it off first (MO=0)";
        axis_.displace(*there, now);
        return {};
    }
    if (name == "shaft_turns") return "shaft_turns: it is read only; position turns the shaft by hand";
    if (name == "bit_rate_code" && link_.bus_rate) {
        if (!number || *number < 0 || *number > 4)
            return "bit_rate_code: " + to_text(value) + " is not 0..4 (1000, 800, 500, 250, 125 kbit/s)";
        memory_.set_flash([&](Protocol& p) { p.bit_rate = static_cast<std::uint8_t>(*number); });
        link_.bit_rate = static_cast<std::uint8_t>(*number);
        return {};
    }
    return "there is no '" + name +
           "' here; power, silent, stall, inputs, home_switch, limit_positive, limit_negative, temperature, inject_error, lost_pulses, "
           "encoder_error, battery_low, position" +
           std::string(link_.bus_rate ? ", bit_rate_code" : "");
}

/// An alarm is sent once when it comes in; the ones that the drive acts upon act.
std::string Device::inject(std::int64_t code, Instant now, Out& out) {
    const auto alarm = static_cast<Alarm>(code);
    if (alarm == injected_) return {};
    if (code == 0) {
        if (injected_ == Alarm::encoder_error) encoder_error_ = false;
        if (injected_ == Alarm::battery_low) battery_low_ = false;
        injected_ = Alarm::none;
        return {};
    }
    if (!online_) return "inject_error: the drive has no power";
    injected_ = alarm;
    switch (alarm) {
        case Alarm::emergency_lock:
            axis_.stop_fast(now, memory_.ram().sd);
            flags_.lock = true;
            raise(alarm, now, out);
            break;
        case Alarm::lower_limit:
        case Alarm::upper_limit:
            axis_.stop_fast(now, memory_.ram().sd);  // "soft bumper limit is hit" [L1409]
            raise(alarm, now, out);
            break;
        case Alarm::stall:
            on_axis(Axis::Event::stalled, now, out);
            break;
        case Alarm::encoder_error:
            return set_condition("encoder_error", true, now, out);
        case Alarm::battery_low:
            return set_condition("battery_low", true, now, out);
        default:
            raise(alarm, now, out);
            break;
    }
    return {};
}

}  // namespace axisgate::uim342::twin
