// Mechanics of the simulated servo: the plans.
// In: orders. Out: pieces of constant acceleration. Never keeps more than one plan: at most five pieces.
#include "adapters/cia402/twin/mechanics.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::cia402_drive::twin {

Motion Mechanics::demand(Instant now) const {
    const double t = seconds(now - since_);
    const Piece* p = &pieces_.front();
    for (const Piece& x : pieces_)
        if (x.begin <= t) p = &x;
    const double d = std::max(0.0, t - p->begin);
    // Between two steps of a cyclic mode a shaft does not stand: the next one may come a little late.
    if (step_velocity_ != 0 && t >= end_ && t < 1.25 * end_) return {p->position, step_velocity_};
    return {p->position + d * (p->velocity + d * p->acceleration / 2), p->velocity + d * p->acceleration};
}
Motion Mechanics::shaft(Instant now) const { return held_ ? Motion{held_at_, 0} : demand(now); }

void Mechanics::begin(Instant now) {
    at_ = demand(now);
    since_ = now;
    end_ = step_velocity_ = 0;
    pieces_.clear();
}
void Mechanics::add(double s, double a) {
    pieces_.push_back({end_, at_.position, at_.velocity, a});
    at_ = {at_.position + s * (at_.velocity + s * a / 2), at_.velocity + s * a};
    end_ += s;
}

void Mechanics::move(double target, const Ramps& r, Instant now) {
    begin(now);
    double way = target - at_.position;
    if (at_.velocity != 0 && (way - at_.velocity * std::fabs(at_.velocity) / (2 * r.down)) * at_.velocity < 0) {  // it cannot stop in time
        add(std::fabs(at_.velocity) / r.down, -std::copysign(r.down, at_.velocity));
        at_.velocity = 0;
        way = target - at_.position;
    }
    const double side = std::copysign(1.0, way), v = std::fabs(at_.velocity);
    const double peak = std::min(r.velocity, std::sqrt((2 * r.up * r.down * std::fabs(way) + r.down * v * v) / (r.up + r.down)));
    if (peak > 0) {
        add(std::fabs(peak - v) / (peak > v ? r.up : r.down), side * (peak > v ? r.up : -r.down));
        at_.velocity = side * peak;
        add(std::max(0.0, (side * (target - at_.position) - peak * peak / (2 * r.down)) / peak), 0);
        add(peak / r.down, -side * r.down);
        at_.position = target;
    }
    at_.velocity = 0;
    rest();
}
void Mechanics::run(double velocity, const Ramps& r, Instant now) {
    begin(now);
    const auto change = [&](double to, double rate) {
        if (to == at_.velocity) return;
        add(std::fabs(to - at_.velocity) / rate, std::copysign(rate, to - at_.velocity));
        at_.velocity = to;
    };
    if (velocity * at_.velocity < 0) change(0, r.down);
    change(velocity, std::fabs(velocity) > std::fabs(at_.velocity) ? r.up : r.down);
    rest();
}
void Mechanics::step_to(double target, double s, Instant now) {
    begin(now);
    const bool there = std::fabs(target - at_.position) < 1e-6 || s <= 0;
    at_.velocity = there ? 0 : (target - at_.position) / s;
    if (!there) add(s, 0);
    step_velocity_ = at_.velocity;
    at_ = {target, 0};
    rest();
}
void Mechanics::push(double acceleration, double most, Instant now) {
    begin(now);
    const double to = std::copysign(most, acceleration);
    if (acceleration != 0 && at_.velocity != to && (to - at_.velocity) * acceleration > 0) {
        add((to - at_.velocity) / acceleration, acceleration);
        at_.velocity = to;
    }
    rest();
}
void Mechanics::rest_at(double position, Instant now) {
    begin(now);
    at_ = {position, 0};
    rest();
}
void Mechanics::hold(bool held, Instant now) {
    if (held && !held_) held_at_ = demand(now).position;
    held_ = held;
}
Instant Mechanics::end() const { return since_ + Duration{std::llround(std::ceil(end_ * 1e9))}; }
bool Mechanics::moves(Instant now) const { return now < end() || pieces_.back().velocity != 0; }

}  // namespace axisgate::cia402_drive::twin
