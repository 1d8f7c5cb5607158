#include "adapters/linmot/twin/monitor.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::linmot::twin {
namespace {
// Times and levels without a UPID: choices.
constexpr Duration ptc_warn = std::chrono::milliseconds(100), ptc_error = std::chrono::milliseconds(500);
constexpr Duration hot_error = std::chrono::milliseconds(500);
constexpr Duration sve_time = std::chrono::microseconds(500);   ///< [L4398]
constexpr Duration warm_step = std::chrono::milliseconds(100);  ///< period of the temperature calculation while something is being heated
constexpr double winding_ohm = 10, winding_error = 1200;        ///< 0.1 deg C
double value(std::int64_t v) { return static_cast<double>(v); }
bool lasts(Instant since, Duration time, Instant now) noexcept { return since != never && now >= since + time; }
}  // namespace

void Monitor::power_on(Instant now) {
    resistor_.settle(memory_.number(0x102A) / 10);
    motor_.settle(memory_.number(0x102A) / 10);
    warmed_ = now;
    show_temperatures();
}

/// The regeneration resistor is heated between its switching voltages, the motor by its current. 0.1 deg C.
void Monitor::warm(Instant now) {
    const double past = seconds(now - warmed_), environment = memory_.number(0x102A) / 10;
    const double volt = value(outside_.motor_supply) / 100, ampere = value(outside_.current) / 1000;
    const auto with = [&](std::uint16_t upid) { return std::max(1e-3, memory_.number(upid)); };
    resistor_.run(past, regenerates_ ? volt * volt / with(0x1022) : 0, {{{with(0x1026), with(0x1027)}, {with(0x1028), with(0x1029)}}},
                  environment);
    motor_.run(past, ampere * ampere * winding_ohm,
               {{{with(0x120C), with(0x1210)}, {with(0x1211), with(0x1212)}, {with(0x1213), with(0x1214)}}}, environment);
    warmed_ = now;
    memory_.set_ram(0x1C0D, static_cast<std::uint32_t>(std::llround(resistor_.temperature[0] * 10)));
    const double on = memory_.number(0x101E), off = memory_.number(0x101F), supply = value(outside_.motor_supply);
    regenerates_ = memory_.ram(0x101D) != 0 && (supply > on || (regenerates_ && supply >= off));
}

void Monitor::seen(const Outside& next, Instant now) noexcept {
    const auto since = [&](bool is, Instant& instant) { instant = !is ? never : instant == never ? now : instant; };
    since(next.ptc1_hot, ptc1_since_);
    since(next.ptc2_hot, ptc2_since_);
    since(next.motor_hot, motor_hot_since_);
    since(!next.safe_voltage_enable, sve_low_since_);
}

void Monitor::show_temperatures() {
    for (std::uint16_t u = 0x1BC6; u <= 0x1BCD; ++u) {
        const bool meant = outside_.sensor == 0 || outside_.sensor == u - 0x1BC5;
        memory_.set_ram(u, static_cast<std::uint32_t>(meant ? outside_.temperature : Outside{}.temperature));
    }
}

Instant Monitor::due(Instant now) const {
    Instant at = never;
    const auto after = [&](Instant since, Duration time) {
        if (since != never && since + time > now) at = std::min(at, since + time);
    };
    after(ptc1_since_, ptc_error);
    after(ptc2_since_, ptc_error);
    after(motor_hot_since_, hot_error);
    after(sve_low_since_, sve_time);
    if (warms()) at = std::min(at, warmed_ + warm_step);
    return at;
}

bool Monitor::warms() const noexcept {
    const double environment = memory_.number(0x102A) / 10 + 0.1;
    return regenerates_ || outside_.current != 0 || resistor_.temperature[0] > environment || motor_.temperature[0] > environment;
}

bool Monitor::watches() const noexcept {
    return ptc1_since_ != never || ptc2_since_ != never || motor_hot_since_ != never || sve_low_since_ != never || warms();
}

Fault Monitor::fault(Instant now) const {
    if (value(outside_.logic_supply) < memory_.number(0x100E)) return 0x01;
    if (value(outside_.logic_supply) > memory_.number(0x1010)) return 0x02;
    if (value(outside_.motor_supply) < memory_.number(0x101A)) return 0x03;
    if (value(outside_.motor_supply) > memory_.number(0x101B)) return 0x04;
    if (memory_.number(0x1C0D) > memory_.number(0x1025)) return 0x15;  // by the number in the manual (E-31)
    if (motor_.temperature[0] * 10 > winding_error) return 0x23;
    // The sensors in their order: Ph1+, Ph1-, Ph2+, Ph2-, DC link, resistor driver, X3, core; the B1100 series has only the last one.
    for (std::uint16_t i = series_ == Series::b1100 ? 7 : 0; i < 8; ++i) {
        if (memory_.number(static_cast<std::uint16_t>(0x1BC6 + i)) > memory_.number(0x1041)) return static_cast<Fault>(0x10 + i);
    }
    if (lasts(motor_hot_since_, hot_error, now)) return 0x20;
    if (lasts(ptc1_since_, ptc_error, now)) return 0x06;
    if (lasts(ptc2_since_, ptc_error, now)) return 0x0F;
    return 0;
}

std::uint16_t Monitor::warnings(Instant now) const {
    std::uint16_t w = 0;
    const auto set = [&](int bit, bool on) { w = static_cast<std::uint16_t>(w | (on ? 1u << bit : 0u)); };
    set(0, outside_.motor_hot);
    set(1, motor_.temperature[0] > 100);
    set(2, value(outside_.motor_supply) < memory_.number(0x1018));
    set(3, value(outside_.motor_supply) > memory_.number(0x1019));
    set(6, static_cast<double>(hottest()) > memory_.number(0x1040));
    set(8, lasts(ptc1_since_, ptc_warn, now));
    set(9, lasts(ptc2_since_, ptc_warn, now));
    set(10, memory_.number(0x1C0D) > memory_.number(0x1024));
    return w;
}

/// The switching voltages must be above the supply at rest, and half a volt apart.
Fault Monitor::misconfigured() const {
    if (memory_.ram(0x101D) == 0) return 0;
    const double on = memory_.number(0x101E), off = memory_.number(0x101F), idle = value(outside_.motor_supply);
    if (on < idle || off < idle) return 0x60;
    return on - off < 50 ? 0x61 : 0;
}

bool Monitor::unsafe(Instant now) const noexcept { return lasts(sve_low_since_, sve_time, now); }

bool Monitor::persists(Fault fault) const noexcept {
    return (fault == 0x06 && outside_.ptc1_hot) || (fault == 0x0F && outside_.ptc2_hot) || (fault == 0x20 && outside_.motor_hot);
}

std::uint32_t Monitor::hottest() const noexcept {
    std::uint32_t most = 0;
    for (std::uint16_t u = 0x1BC6; u <= 0x1BCD; ++u)
        most = std::max(most, memory_.ram(u));
    return most;
}

}  // namespace axisgate::linmot::twin
