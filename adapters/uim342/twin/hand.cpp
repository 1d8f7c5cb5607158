// The tester's hand: outside conditions of the drive, by the names that all families share.
// In: names and values. Out: what they cause on the wire, or why they make no sense.
// Never writes a register, but for the bit rate that a service tool would set back.
#include <algorithm>
#include <string>

#include "adapters/uim342/twin/device_reports.hpp"

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

Value level(const Inputs& inputs, unsigned bit) { return ((inputs.applied() >> bit) & 1u) != 0; }

std::string set_level(Inputs& inputs, unsigned bit, const HandWish& w) {
    return w.flag([&](bool high) {
        const unsigned rest = inputs.applied() & ~(1u << bit);
        inputs.apply(static_cast<std::uint8_t>(high ? rest | 1u << bit : rest), w.now);
    });
}

}  // namespace

const HandRow<Device> Device::conditions[] = {
    {"power", true, "supply voltage; off loses everything that is not in FLASH or EEPROM",
     [](const Device& d, Instant) -> Value { return d.powered_; },
     [](Device& d, const HandWish& w) {
         return w.flag([&](bool on) {
             if (on == d.powered_) return;
             if (!on) return d.power_off(w.now);
             d.powered_ = true;
             d.boot(w.now, d.axis_.place(w.now), {});
         });
     }},
    {"silent", true, "the drive hears and acts, but nothing that it sends reaches the line",
     [](const Device& d, Instant) -> Value { return d.link_.silent; },
     [](Device& d, const HandWish& w) { return w.flag([&](bool on) { d.link_.silent = on; }); }},
    {"stall", true, "the shaft is held; in closed loop (IC[6] = 1) the drive detects it after QE[1] pulses, in open loop never",
     [](const Device& d, Instant) -> Value { return d.axis_.held(); },
     [](Device& d, const HandWish& w) { return w.flag([&](bool on) { d.on_axis(d.axis_.hold(on, w.now), w.now, *w.out); }); }},
    {"inputs", true,
     "levels of IN1 (bit 0), IN2 (bit 1), IN3 (bit 2), sampled each ms. Limit and home switches are wired here: the drive "
     "has no input of its own for them, IL[0..2] say what a level change does",
     [](const Device& d, Instant) -> Value { return std::int64_t{d.inputs_.applied()}; },
     [](Device& d, const HandWish& w) {
         return w.whole(0, 7, "0..7 (bit 0: IN1, bit 1: IN2, bit 2: IN3)",
                        [&](std::int64_t n) { d.inputs_.apply(static_cast<std::uint8_t>(n), w.now); });
     }},
    // Where a machine would have them: the drive knows inputs alone, and IL[0..2] say what a change of each does.
    {"home_switch", true, "a switch at IN1 (bit 0 of inputs), true: high; IL[0] says what the drive does",
     [](const Device& d, Instant) { return level(d.inputs_, 0); }, [](Device& d, const HandWish& w) { return set_level(d.inputs_, 0, w); }},
    {"limit_positive", true, "a switch at IN2 (bit 1 of inputs), true: high; IL[1] says what the drive does",
     [](const Device& d, Instant) { return level(d.inputs_, 1); }, [](Device& d, const HandWish& w) { return set_level(d.inputs_, 1, w); }},
    {"limit_negative", true, "a switch at IN3 (bit 2 of inputs), true: high; IL[2] says what the drive does",
     [](const Device& d, Instant) { return level(d.inputs_, 2); }, [](Device& d, const HandWish& w) { return set_level(d.inputs_, 2, w); }},
    {"temperature", true, "of the motor, deg C; nothing follows from it: the manual gives the drive neither a reading nor an alarm of it",
     [](const Device& d, Instant) -> Value { return d.temperature_; },
     [](Device& d, const HandWish& w) { return w.number(-50, 200, "-50..200 deg C", [&](double degrees) { d.temperature_ = degrees; }); }},
    {"inject_error", true,
     "an alarm: 10 emergency stop and lock, 25 overspeed, 26 lower limit, 27 upper limit, 29 stall, 30 encoder error, "
     "31 battery low; sent once, 0 ends the condition",
     [](const Device& d, Instant) -> Value { return static_cast<std::int64_t>(d.injected_); },
     // An alarm is sent once when it comes in; the ones that the drive acts upon act.
     [](Device& d, const HandWish& w) -> std::string {
         const auto code = as_integer(w.value);
         if (!code || (*code != 0 && !known_alarm(*code)))
             return w.is_not("an alarm of this drive; 10, 25, 26, 27, 29, 30, 31 (hex 0A 19 1A 1B 1D 1E 1F), 0 ends it");
         const auto alarm = static_cast<Alarm>(*code);
         if (alarm == d.injected_) return {};
         if (*code == 0) {
             if (d.injected_ == Alarm::encoder_error) d.encoder_error_ = false;
             if (d.injected_ == Alarm::battery_low) d.battery_low_ = false;
             d.injected_ = Alarm::none;
             return {};
         }
         if (!d.online_) return "inject_error: the drive has no power";
         d.injected_ = alarm;
         switch (alarm) {
             case Alarm::emergency_lock:
                 d.axis_.stop_fast(w.now, d.memory_.ram().sd);
                 d.flags_.lock = true;
                 DeviceReports(d).raise(alarm, w.now, *w.out);
                 break;
             case Alarm::lower_limit:
             case Alarm::upper_limit:
                 d.axis_.stop_fast(w.now, d.memory_.ram().sd);  // "soft bumper limit is hit" [L1409]
                 DeviceReports(d).raise(alarm, w.now, *w.out);
                 break;
             case Alarm::stall:
                 d.on_axis(Axis::Event::stalled, w.now, *w.out);
                 break;
             case Alarm::encoder_error:
                 d.set_alarm_condition(d.encoder_error_, alarm, true, w.now, *w.out);
                 break;
             case Alarm::battery_low:
                 d.set_alarm_condition(d.battery_low_, alarm, true, w.now, *w.out);
                 break;
             default:
                 DeviceReports(d).raise(alarm, w.now, *w.out);
                 break;
         }
         return {};
     }},
    {"lost_pulses", true,
     "writing adds pulses that the motor did not follow, 0 forgets them; reading: lost since the last start (closed loop)",
     [](const Device& d, Instant) -> Value { return d.axis_.lost(); },
     [](Device& d, const HandWish& w) {
         return w.whole(0, 1'000'000, "0..1000000", [&](std::int64_t n) -> std::string {
             if (n == 0) return d.axis_.forget_lost(w.now), std::string();
             if (!d.axis_.driver_on())
                 return "lost_pulses: the driver is off, so no pulses are sent and none can be lost; switch it on first (MO=1)";
             d.on_axis(d.axis_.lose(n, w.now), w.now, *w.out);
             return {};
         });
     }},
    {"encoder_error", true, "the encoder is broken: alarm 1E, at power-on too",
     [](const Device& d, Instant) -> Value { return d.encoder_error_; },
     [](Device& d, const HandWish& w) {
         return w.flag([&](bool on) { d.set_alarm_condition(d.encoder_error_, Alarm::encoder_error, on, w.now, *w.out); });
     }},
    {"battery_low", true, "battery of the absolute encoder: alarm 1F, QE[3] = 0",
     [](const Device& d, Instant) -> Value { return d.battery_low_; },
     [](Device& d, const HandWish& w) {
         return w.flag([&](bool on) { d.set_alarm_condition(d.battery_low_, Alarm::battery_low, on, w.now, *w.out); });
     }},
    {"position", true, "shaft position, pulses; can be turned by hand while the driver is off",
     [](const Device& d, Instant at) -> Value {
         return at != Instant::min() ? std::int64_t{wrap_i32(d.axis_.shaft(at).position)} : std::int64_t{0};
     },
     [](Device& d, const HandWish& w) {
         return w.number(-2147483647.0, 2147483647.0, "a position of 32 bits, in pulses", [&](double there) -> std::string {
             if (d.axis_.driver_on()) return "position: the driver holds the shaft; switch it off first (MO=0)";
             d.axis_.displace(there, w.now);
             return {};
         });
     }},
    {"shaft_turns", false, "turns of the shaft, counter-clockwise positive: what MT[0], QE[0], QE[2], QE[4] and IC[1] make of the pulses",
     [](const Device& d, Instant at) -> Value { return at != Instant::min() ? d.axis_.turns(at) : 0.0; },
     [](Device&, const HandWish&) -> std::string { return "shaft_turns: it is read only; position turns the shaft by hand"; }},
    {"bit_rate_code", true,
     "bit rate of the CAN line that the drive hears, as a code of PP[5]; writing sets PP[5] and acts at once, as a "
     "service tool at the drive would: the way back after a wrong PP[5]",
     [](const Device& d, Instant) -> Value { return std::int64_t{d.link_.bit_rate}; },
     [](Device& d, const HandWish& w) {
         return w.whole(0, 4, "0..4 (1000, 800, 500, 250, 125 kbit/s)", [&](std::int64_t code) {
             d.memory_.set_flash([&](Protocol& p) { p.bit_rate = static_cast<std::uint8_t>(code); });
             d.link_.bit_rate = static_cast<std::uint8_t>(code);
         });
     },
     [](const Device& d) { return d.link_.bus_rate.has_value(); }},
};

std::vector<HandItem> Device::hand() const { return hand_items(conditions, *this, last_); }

std::string Device::set_hand(const std::string& name, const Value& value, Instant now, Out& out) {
    now = std::max(now, last_);
    settle(now, out);
    const auto answer = set_hand_row(conditions, *this, *this, {name, value, now, &out});
    settle(now, out);
    if (answer) return *answer;
    std::string names;
    for (const auto& row : conditions) {
        if (row.writable && (!row.fitted || row.fitted(*this))) names += (names.empty() ? "" : ", ") + std::string(row.name);
    }
    return "there is no '" + name + "' here; " + names;
}

void Device::set_alarm_condition(bool& condition, Alarm alarm, bool on, Instant now, Out& out) {
    if (on && !condition && online_) DeviceReports(*this).raise(alarm, now, out);
    condition = on;
}

}  // namespace axisgate::uim342::twin
