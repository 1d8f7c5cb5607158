// What a simulated drive watches: supplies, temperatures and their models, sensors, force, limit switches. Warnings come before their
// errors. In: what is outside, time. Out: errors at their instant. Never clears an error.
#include <algorithm>
#include <cmath>

#include "adapters/linmot/twin/drive.hpp"

namespace axisgate::linmot::twin {
namespace {
// Times and levels without a UPID: choices.
constexpr Duration ptc_error = std::chrono::milliseconds(500), hot_error = std::chrono::milliseconds(500);
constexpr Duration warm_step = std::chrono::milliseconds(100);  ///< how often temperatures are looked at while something heats
constexpr double winding_ohm = 10, winding_error = 1200;        ///< 0.1 deg C
double value(std::int64_t v) { return static_cast<double>(v); }
}  // namespace

/// The two models up to now: the regeneration resistor between its switching voltages, the motor by its current. 0.1 deg C.
void Drive::warm(Instant now) {
    const double past = seconds(now - warmed_), environment = memory.number(0x102A) / 10;
    const double volt = value(outside_.motor_supply) / 100, ampere = value(outside_.current) / 1000;
    const auto with = [&](std::uint16_t upid) { return std::max(1e-3, memory.number(upid)); };
    resistor_.run(past, regenerates_ ? volt * volt / with(0x1022) : 0, {{{with(0x1026), with(0x1027)}, {with(0x1028), with(0x1029)}}},
                  environment);
    motor_.run(past, ampere * ampere * winding_ohm,
               {{{with(0x120C), with(0x1210)}, {with(0x1211), with(0x1212)}, {with(0x1213), with(0x1214)}}}, environment);
    warmed_ = now;
    memory.set_ram(0x1C0D, static_cast<std::uint32_t>(std::llround(resistor_.temperature[0] * 10)));
    const double on = memory.number(0x101E), off = memory.number(0x101F), supply = value(outside_.motor_supply);
    regenerates_ = memory.ram(0x101D) != 0 && (supply > on || (regenerates_ && supply >= off));
}

Instant Drive::monitor_due() const {
    Instant at = never;
    const auto after = [&](Instant since, Duration time) {
        if (since != never && since + time > now_) at = std::min(at, since + time);
    };
    after(ptc1_since_, ptc_error);
    after(ptc2_since_, ptc_error);
    after(motor_hot_since_, hot_error);
    after(sve_low_since_, sve_time);
    if (state_ == aborting && abort_over_ != never) at = std::min(at, std::max(abort_over_, now_));
    if (warms()) at = std::min(at, warmed_ + warm_step);
    return at;
}

bool Drive::warms() const noexcept {
    const double environment = memory.number(0x102A) / 10 + 0.1;
    return regenerates_ || outside_.current != 0 || resistor_.temperature[0] > environment || motor_.temperature[0] > environment;
}
/// Whether something that check_outside() looks at can have changed by time alone.
bool Drive::monitors() const noexcept {
    return ptc1_since_ != never || ptc2_since_ != never || motor_hot_since_ != never || sve_low_since_ != never || abort_over_ != never ||
           warms();
}

void Drive::check_outside(Instant now) {
    if (!running_) return;
    warm(now);
    if (value(outside_.logic_supply) < memory.number(0x100E)) raise(0x01, now);
    if (value(outside_.logic_supply) > memory.number(0x1010)) raise(0x02, now);
    if (value(outside_.motor_supply) < memory.number(0x101A)) raise(0x03, now);
    if (value(outside_.motor_supply) > memory.number(0x101B)) raise(0x04, now);
    if (memory.number(0x1C0D) > memory.number(0x1025)) raise(0x15, now);  // by the number that the manual gives there (E-31)
    if (motor_.temperature[0] * 10 > winding_error) raise(0x23, now);
    // The sensors in their order: Ph1+, Ph1-, Ph2+, Ph2-, DC link, resistor driver, X3, core; the smaller series has the last one alone.
    for (std::uint16_t i = setup_.series == Series::b1100 ? 7 : 0; i < 8; ++i) {
        if (memory.number(static_cast<std::uint16_t>(0x1BC6 + i)) > memory.number(0x1041)) raise(static_cast<std::uint16_t>(0x10 + i), now);
    }
    const auto over = [&](Instant since, Duration time) { return since != never && now >= since + time; };
    if (over(motor_hot_since_, hot_error)) raise(0x20, now);
    if (over(ptc1_since_, ptc_error)) raise(0x06, now);
    if (over(ptc2_since_, ptc_error)) raise(0x0F, now);
    if (const auto f = value(outside_.force); force_watch_ && (force_higher_ ? f >= force_limit_ : f <= force_limit_)) {
        force_watch_ = false;
        force_control_ = true;
        profile_.rest(demand_at(now).position, now);  // the force is held; the model moves no further
    }
    // Limit switches count only while the drive is powered and homed; the switch takes the home away (E-45).
    if ((outside_.limit_in || outside_.limit_out) && controlled() && homed_ && memory.ram(0x121B) != 0) {
        const std::uint16_t code = outside_.limit_in ? 0x87 : 0x88;
        if (memory.ram(0x121B) == 1) {
            error_ = code;
            enter(error, now);
        } else {
            raise(code, now);
        }
        homed_ = false;
    }
}

void Drive::show_temperatures() {
    for (std::uint16_t u = 0x1BC6; u <= 0x1BCD; ++u) {
        const bool meant = outside_.sensor == 0 || outside_.sensor == u - 0x1BC5;
        memory.set_ram(u, static_cast<std::uint32_t>(meant ? outside_.temperature : Outside{}.temperature));
    }
}

void Drive::set_outside(const Outside& outside, Instant now) {
    advance(now);
    follow_step(now);
    warm(now);
    if (outside.stall && !outside_.stall) stalled_at_ = actual_at(now).position;
    master_.set(outside.encoder != outside_.encoder ? value(outside.encoder) : master_.edges(now), value(outside.encoder_speed), now);
    const auto since = [&](bool is, Instant& instant) { instant = !is ? never : instant == never ? now : instant; };
    since(outside.ptc1_hot, ptc1_since_);
    since(outside.ptc2_hot, ptc2_since_);
    since(outside.motor_hot, motor_hot_since_);
    since(!outside.safe_voltage_enable, sve_low_since_);
    outside_ = outside;
    show_temperatures();
    follow_step(now);
    check_outside(now);
    if (indexing_) index(now);
    compute_control_word(now);
    now_ = now;
}

}  // namespace axisgate::linmot::twin
