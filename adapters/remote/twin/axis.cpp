// A new order continues from the state that the previous one has reached, without a jump.
#include "adapters/remote/twin/axis.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::remote::twin {
using mirror::Answer;
namespace {
constexpr double quick_stop = 40000;  // increments/s^2
constexpr double window = 10;         // increments: the shaft is at its target
Answer taken() { return {Outcome::accepted, Reason::none, 0, {}}; }
Answer refused(Reason reason, std::string why) { return {Outcome::refused, reason, 0, std::move(why)}; }
}  // namespace

Axis::Axis(const FreedomValues& f, std::uint64_t seed)
    : real_(shaft_freedoms(f), seed),
      power_delay_(std::chrono::milliseconds(freedom(f, "enable_ms"))),
      start_(static_cast<double>(freedom(f, "start_position_increments"))),
      most_error_(static_cast<double>(freedom(f, "following_error_increments"))),
      limit_(static_cast<double>(freedom(f, "limit_increments"))),
      homes_(freedom(f, "homing", 1) != 0),
      sets_position_(freedom(f, "set_position", 1) != 0),
      reports_demand_(freedom(f, "demand", 1) != 0),
      zero_(-start_) {}

void Axis::advance(Instant now) {
    if (held_until_ <= now) {
        follow(held_until_);
        if (held_until_ != never) shaft_.stop(ramps_, held_until_);  // a following error may have ended it
        held_until_ = never;
    }
    follow(now);
}

/// If a specimen has mechanics or watches its following error.
void Axis::follow(Instant now) {
    if (!real_.differs() && most_error_ == 0) return;
    if (on_) {
        const Instant behind = shaft_.held() ? held_behind(now) : follow_demand(now);
        if (behind != never) {
            rest(behind);
            fault_ = true;
        }
    }
    if (!on_ && was_on_ && !shaft_.held()) real_.advance_without_power(now);
    followed_ = std::max(followed_, now);
}
/// The first instant at which it is too far behind; `never`: it is not until then.
Instant Axis::follow_demand(Instant now) {
    const auto demand = [this](Instant t) { return shaft_.demand(t).position; };
    if (most_error_ == 0) return real_.advance(now, demand), never;
    return real_.advance_until(now, demand, [this](const ShaftPoint& p) { return std::fabs(p.demand - p.position) > most_error_; });
}
/// As long as its demand moves, a shaft that is held gets further behind; each millisecond is looked at.
Instant Axis::held_behind(Instant now) {
    const double here = shaft_.shaft(now).position;
    const auto too_far = [&](Instant t) { return most_error_ != 0 && std::fabs(shaft_.demand(t).position - here) > most_error_; };
    Instant behind = never;
    if (too_far(now) || (most_error_ != 0 && shaft_.moves(followed_))) {
        if (now - followed_ > Shaft::longest_gap) followed_ = now - Shaft::longest_gap;
        for (Instant t = time_zero + ((followed_ - time_zero) / Shaft::step + 1) * Shaft::step; t <= now && behind == never;
             t += Shaft::step)
            if (too_far(t)) behind = t;
    }
    real_.set(here, std::min(now, behind));
    return behind;
}

void Axis::rest(Instant now) {
    shaft_.rest_at(real_.differs() && !shaft_.held() ? real_.position() : shaft_.shaft(now).position, now);
    on_ = quick_ = to_target_ = false;
    held_until_ = never;
}

void Axis::hold(bool held, Instant now) {
    advance(now);
    shaft_.hold(held, now);
}

void Axis::fail(bool failed, Instant now) {
    advance(now);
    if (failed) rest(now);
    fault_ = failed;
}

void Axis::power_off(Instant now) {
    fail(true, now);
    fault_ = referenced_ = homed_ = false;
    mode_ = 1;
}

TwinMechanics Axis::mechanics(Instant now) const {
    Axis copy = *this;  // a query must not change the axis
    copy.advance(now);
    const auto s = copy.shaft_.shaft(now);
    const bool real = real_.differs() && !shaft_.held();
    return {real ? copy.place(now) : s.position, real ? copy.real_.velocity() : s.velocity, copy.powered(now)};
}

bool Axis::beyond_limit(double position) const { return limit_ > 0 && std::fabs(position - zero_) > limit_; }

Answer Axis::order(const mirror::Order& o, Instant now) {
    advance(now);
    const auto no = [](const char* why) { return refused(Reason::wrong_state, why); };
    if (o.verb == "enable") {
        if (fault_) return no("the axis is in a fault: reset it first");
        if (!on_) {
            if (was_on_ && real_.differs() && !shaft_.held()) shaft_.rest_at(real_.position(), now);  // it has drifted
            on_from_ = now + power_delay_;
        }
        on_ = was_on_ = true;
        quick_ = false;
        return taken();
    }
    if (o.verb == "disable") return rest(now), taken();
    if (o.verb == "halt" || o.verb == "quick_stop") {
        const bool quick = o.verb == "quick_stop";
        if (on_ && shaft_.moves(now)) shaft_.stop(quick ? cia402_drive::twin::Ramps{0, quick_stop, quick_stop} : ramps_, now);
        held_until_ = never;
        to_target_ = false;
        quick_ = quick_ || (quick && on_);
        return taken();
    }
    if (o.verb == "reset_fault") return fault_ = false, taken();
    if (o.verb == "home") {
        if (!homes_) return refused(Reason::not_supported, "the drive has no homing");
        if (!powered(now) || quick_) return no("the axis is not enabled");
        if (o.method && *o.method != 0 && *o.method != 35 && *o.method != 37)
            return refused(Reason::out_of_range, "the drive knows the methods 35 and 37");
        if (shaft_.moves(now)) return no("the axis moves");
        mode_ = 6;
        zero_ = place(now);
        referenced_ = homed_ = true;
        to_target_ = false;
        return taken();
    }
    if (o.verb == "set_position") {
        if (!sets_position_) return refused(Reason::not_supported, "the position of this drive cannot be set");
        if (shaft_.moves(now)) return no("the axis moves");
        if (!o.position) return refused(Reason::out_of_range, "position is missing");
        zero_ = place(now) - static_cast<double>(*o.position);
        return referenced_ = true, taken();
    }
    return o.verb.starts_with("move_") ? move(o, now) : refused(Reason::not_supported, "there is no command " + o.verb);
}

Answer Axis::move(const mirror::Order& o, Instant now) {
    const bool turns = o.verb == "move_velocity";
    if (o.renew) {
        if (held_until_ == never) return refused(Reason::wrong_state, "the axis does not move by a held move");
        if (o.hold_ms) held_until_ = now + std::chrono::milliseconds(*o.hold_ms);
        return taken();
    }
    if (!powered(now) || quick_) return refused(Reason::wrong_state, "the axis is not enabled");
    if (!(turns ? o.velocity : o.position)) return refused(Reason::out_of_range, "the target is missing");
    for (const auto& value : {turns ? std::optional<std::int64_t>() : o.velocity, o.acceleration, o.deceleration}) {
        if (value && *value <= 0) return refused(Reason::out_of_range, "speeds and ramps are greater than zero");
    }
    const double target = turns ? 0 : (o.verb == "move_relative" ? shaft_.demand(now).position : zero_) + static_cast<double>(*o.position);
    if (!turns && beyond_limit(target)) return refused(Reason::out_of_range, "the target is beyond the limits of the axis at its gateway");
    if (o.acceleration) ramps_.up = static_cast<double>(*o.acceleration);
    if (o.deceleration) ramps_.down = static_cast<double>(*o.deceleration);
    if (!turns && o.velocity) ramps_.velocity = static_cast<double>(*o.velocity);
    mode_ = turns ? 3 : 1;
    homed_ = false;
    to_target_ = !turns;
    held_until_ = turns && o.hold_ms ? now + std::chrono::milliseconds(*o.hold_ms) : never;
    if (turns) {
        shaft_.run(static_cast<double>(*o.velocity), ramps_, now);
    } else {
        shaft_.move(target, ramps_, now);
    }
    return taken();
}

mirror::State Axis::state(Instant now) const {
    const auto shaft = shaft_.shaft(now), demand = shaft_.demand(now);
    const bool real = real_.differs() && !shaft_.held(), on = powered(now);
    const bool there = !real || std::fabs(real_.load() - demand.position) <= window;
    mirror::State s;
    s.simulated = false;
    s.referenced = referenced_;
    s.moving = shaft_.moves(now);
    s.target_reached = to_target_ && !s.moving && !shaft_.held() && there;
    s.fault = fault_;
    s.statusword = fault_ ? 0x0208 : !on ? 0x0240 : quick_ ? 0x0207 : 0x0227;
    if (s.target_reached || mode_ == 6) s.statusword |= 0x0400;
    if (mode_ == 6 && homed_) s.statusword |= 0x1000;
    s.mode = mode_;
    s.position = std::llround((real ? real_.shown() : shaft.position) - zero_);
    s.demand = reports_demand_ ? std::llround(demand.position - zero_) : 0;
    s.demand_source = on && reports_demand_ ? DemandSource::drive : DemandSource::none;
    s.velocity = std::llround(real ? real_.velocity() : shaft.velocity);
    s.error_code = fault_ ? fault_code : 0;
    return s;
}

}  // namespace axisgate::remote::twin
