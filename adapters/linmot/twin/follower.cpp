// A limit of 0 means that there is no limit.
#include "adapters/linmot/twin/follower.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::linmot::twin {

Instant Follower::advance(Instant now, bool watched) {
    if (!shaft_.differs()) return never;
    if (!controlled_) return was_controlled_ ? shaft_.advance_without_power(now) : shaft_.set(place_, now), never;
    if (outside_.stall) return shaft_.set(held_at_, now), never;
    const auto demand = [this](Instant at) {
        const Point d = demand_.at(at);
        return d.position - offset_ - d.velocity * outside_.lag_ms / 1000;
    };
    const double moving = watched ? memory_.number(0x1473) : 0, standing = watched ? memory_.number(standing_) : 0;
    return shaft_.advance_until(now, demand, [&](const ShaftPoint& p) {
        const double most = demand_.moves(p.at) ? moving : standing;
        return most > 0 && std::fabs(p.demand - p.position) > most;
    });
}

bool Follower::swings(Instant now) const {
    if (!shaft_.differs() || !controlled_) return false;
    return demand_.moves(now) || shaft_.velocity() != 0 || std::fabs(shaft_.following_error()) > friction_ + 1;
}

Point Follower::place(Instant now) const {
    if (!controlled_) return {shaft_.differs() ? shaft_.position() : place_, 0};
    if (outside_.stall) return {held_at_, 0};
    if (shaft_.differs()) return {shaft_.position(), shaft_.velocity()};
    const Point d = demand_.at(now);
    return {d.position - offset_ - d.velocity * outside_.lag_ms / 1000, d.velocity};
}

Point Follower::actual(Instant now) const {
    Point p = place(now);
    if (shaft_.differs()) p.position = shaft_.shown();
    p.position += offset_;
    return p;
}

bool Follower::in_target(Instant now) const {
    constexpr double window = 50;  // 5 um: the parameter has no UPID (choice O-11)
    return controlled_ && !demand_.moves(now) && std::fabs(demand_.profile().target() - actual(now).position) <= window;
}

double Follower::home(double position, Instant now) {
    offset_ = position - place(now).position;  // the demand still uses the old numbers: the slider stays where it is
    homed_ = true;
    return position;
}

void Follower::control(bool on) noexcept {
    if (on && shaft_.differs()) place_ = shaft_.position();
    controlled_ = on;
    was_controlled_ = was_controlled_ || on;
    if (on) held_at_ = place_;
}

Instant Follower::lag_limit(Instant now, Instant after) const {
    if (!controlled_ || (!outside_.stall && !shaft_.differs())) return never;
    if (!outside_.stall) {
        const double most = memory_.number(demand_.moves(now) ? 0x1473 : standing_);
        return most > 0 && std::fabs(shaft_.following_error()) > most ? now : never;
    }
    const double limit = memory_.number(0x1473);
    if (limit <= 0) return never;
    const double here = held_at_ + offset_;
    if (std::fabs(demand_.at(now).position - here) > limit) return now;
    if (demand_.led()) return now + watch_step;
    const auto up = demand_.profile().crossing(here + limit, true, after);
    const auto down = demand_.profile().crossing(here - limit, false, after);
    return std::min(up.value_or(never), down.value_or(never));
}

Instant Follower::range_limit(Instant now, Instant after) const {
    if (!controlled_ || demand_.led() || outside_.stall || demand_.profile().over(now) || !homed_) return never;
    const auto up = demand_.profile().crossing(memory_.number(0x146F), true, after);
    const auto down = demand_.profile().crossing(memory_.number(0x146E), false, after);
    return std::min(up.value_or(never), down.value_or(never));
}

}  // namespace axisgate::linmot::twin
