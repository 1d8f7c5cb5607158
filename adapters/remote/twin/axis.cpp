// A new order continues from the state that the previous one has reached, without a jump.
#include "adapters/remote/twin/axis.hpp"

#include <cmath>

namespace axisgate::remote::twin {
using mirror::Answer;
namespace {
constexpr double quick_stop = 40000;  // increments/s^2
Answer taken() { return {Outcome::accepted, Reason::none, 0, {}}; }
Answer refused(Reason reason, std::string why) { return {Outcome::refused, reason, 0, std::move(why)}; }
}  // namespace

void Axis::advance(Instant now) {
    if (held_until_ > now) return;
    shaft_.stop(ramps_, held_until_);
    held_until_ = never;
}

void Axis::rest(Instant now) {
    shaft_.rest_at(shaft_.shaft(now).position, now);
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
    return {s.position, s.velocity, on_};
}

Answer Axis::order(const mirror::Order& o, Instant now) {
    advance(now);
    const auto no = [](const char* why) { return refused(Reason::wrong_state, why); };
    if (o.verb == "enable") {
        if (fault_) return no("the axis is in a fault: reset it first");
        on_ = true;
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
        if (!on_ || quick_) return no("the axis is not enabled");
        if (o.method && *o.method != 0 && *o.method != 35 && *o.method != 37)
            return refused(Reason::out_of_range, "the drive knows the methods 35 and 37");
        if (shaft_.moves(now)) return no("the axis moves");
        mode_ = 6;
        zero_ = shaft_.demand(now).position;
        referenced_ = homed_ = true;
        to_target_ = false;
        return taken();
    }
    if (o.verb == "set_position") {
        if (shaft_.moves(now)) return no("the axis moves");
        if (!o.position) return refused(Reason::out_of_range, "position is missing");
        zero_ = shaft_.demand(now).position - static_cast<double>(*o.position);
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
    if (!on_ || quick_) return refused(Reason::wrong_state, "the axis is not enabled");
    if (!(turns ? o.velocity : o.position)) return refused(Reason::out_of_range, "the target is missing");
    for (const auto& value : {turns ? std::optional<std::int64_t>() : o.velocity, o.acceleration, o.deceleration}) {
        if (value && *value <= 0) return refused(Reason::out_of_range, "speeds and ramps are greater than zero");
    }
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
        const double from = o.verb == "move_relative" ? shaft_.demand(now).position : zero_;
        shaft_.move(from + static_cast<double>(*o.position), ramps_, now);
    }
    return taken();
}

mirror::State Axis::state(Instant now) const {
    const auto shaft = shaft_.shaft(now), demand = shaft_.demand(now);
    mirror::State s;
    s.simulated = false;
    s.referenced = referenced_;
    s.moving = shaft_.moves(now);
    s.target_reached = to_target_ && !s.moving && !shaft_.held();
    s.fault = fault_;
    s.statusword = fault_ ? 0x0208 : !on_ ? 0x0240 : quick_ ? 0x0207 : 0x0227;
    if (s.target_reached || mode_ == 6) s.statusword |= 0x0400;
    if (mode_ == 6 && homed_) s.statusword |= 0x1000;
    s.mode = mode_;
    s.position = std::llround(shaft.position - zero_);
    s.demand = std::llround(demand.position - zero_);
    s.demand_source = on_ ? DemandSource::drive : DemandSource::none;
    s.velocity = std::llround(shaft.velocity);
    s.error_code = fault_ ? fault_code : 0;
    return s;
}

}  // namespace axisgate::remote::twin
