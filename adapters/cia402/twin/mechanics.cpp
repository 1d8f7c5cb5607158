// At most one plan is stored: 17 segments.
#include "adapters/cia402/twin/mechanics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace axisgate::cia402_drive::twin {

Motion Mechanics::demand(Instant now) const {
    const double t = seconds(now - since_);
    const Piece* p = &pieces_.front();
    for (const Piece& x : pieces_)
        if (x.begin <= t) p = &x;
    // A shaft does not stand still between two steps of a cyclic mode: the next step may be slightly late.
    if (step_velocity_ != 0 && t >= end_ && t < 1.25 * end_) return {p->from.position, step_velocity_, 0};
    return along(p->from, p->how, std::max(0.0, t - p->begin));
}
Motion Mechanics::shaft(Instant now) const {
    if (held_) return {held_at_, 0, 0};
    if (motor_.differs()) {
        follow(now);
        return {motor_.position(), motor_.velocity(), 0};
    }
    Motion m = demand(now);
    m.position -= lag_ * m.velocity;
    m.velocity -= lag_ * m.acceleration;
    return m;
}

double Mechanics::read(Instant now) const {
    constexpr double swings_per_s = 1 / 0.007;
    const double swing = swing_ == 0 ? 0 : swing_ * std::sin(2 * std::numbers::pi * swings_per_s * seconds(now - Instant{}));
    const double here = shaft(now).position, play_and_noise = motor_.differs() ? motor_.shown() - motor_.position() : 0;
    return here + play_and_noise + misread_ + swing;
}

void Mechanics::set_shaft(const ShaftFreedoms& freedoms, std::uint64_t seed, Instant now) {
    const double here = shaft(now).position;
    motor_ = Shaft(freedoms, seed);
    motor_.set(here, now);
    ran_out_ = false;
}
void Mechanics::set_power(bool on, Instant now) {
    follow(now);
    on_ = on;
    ran_out_ = false;
}
void Mechanics::follow(Instant now) const {
    if (held_ || !motor_.differs()) return;
    const auto demanded = [this](Instant at) { return demand(at).position; };
    if (on_) return motor_.advance(now, demanded);
    if (!ran_out_) motor_.advance(std::min(now, end()), demanded);
    ran_out_ = ran_out_ || now >= end();
    if (ran_out_) motor_.advance_without_power(now);
}

void Mechanics::begin(Instant now) {
    follow(now);
    at_ = demand(now);
    since_ = now;
    end_ = step_velocity_ = push_from_ = push_to_ = push_slope_ = 0;
    pieces_.clear();
}
void Mechanics::add(const Segment& s) {
    pieces_.push_back({end_, at_, s});
    at_ = along(at_, s, s.seconds);
    end_ += s.seconds;
}
void Mechanics::take(const Profile& profile) {
    for (const Segment& s : profile.segments)
        add(s);
    at_ = profile.end;
    rest();
}

void Mechanics::move(double target, const Ramps& r, Instant now) {
    begin(now);
    take(profile_to_place(at_, target, r));
}
void Mechanics::run(double velocity, const Ramps& r, Instant now) {
    begin(now);
    take(profile_to_speed(at_, velocity, r));
}
void Mechanics::step_to(double target, double s, Instant now) {
    begin(now);
    const bool there = std::fabs(target - at_.position) < 1e-6 || s <= 0;
    at_.velocity = there ? 0 : (target - at_.position) / s;
    at_.acceleration = 0;
    if (!there) add({s});
    step_velocity_ = at_.velocity;
    at_ = {target, 0, 0};
    rest();
}

void Mechanics::push(double acceleration, double slope, double most, Instant now) {
    const double had = pushed(now);
    begin(now);
    push_from_ = slope > 0 ? had : acceleration;
    push_to_ = acceleration;
    push_slope_ = slope;
    const double change = push_to_ - push_from_;
    const Segment slopes[] = {{slope > 0 ? std::fabs(change) / slope : 0, push_from_, std::copysign(slope, change)}, {1e9, acceleration}};
    for (Segment s : slopes) {
        // The top speed ends the segment: from the crossing on, the rest of it does not take place.
        const auto passes = [&](double t) { return std::fabs(along(at_, s, t).velocity) > most; };
        const bool away = std::fabs(at_.velocity) >= most && at_.velocity * (s.acceleration + s.jerk * s.seconds / 2) >= 0;
        if (away || (s.acceleration == 0 && s.jerk == 0)) continue;
        if (passes(s.seconds)) {
            double low = 0, high = s.seconds;
            if (s.jerk == 0) {
                low = (std::copysign(most, s.acceleration) - at_.velocity) / s.acceleration;
            } else {
                for (int i = 0; i < 60; ++i)
                    (passes((low + high) / 2) ? high : low) = (low + high) / 2;
            }
            s.seconds = low;
            add(s);
            at_.velocity = std::copysign(most, at_.velocity);
        } else if (s.seconds > 0) {
            add(s);
        }
    }
    at_.acceleration = 0;
    rest();
}
double Mechanics::pushed(Instant now) const {
    if (push_slope_ <= 0) return push_to_;
    const double change = push_to_ - push_from_, done = push_slope_ * seconds(now - since_);
    return done >= std::fabs(change) ? push_to_ : push_from_ + std::copysign(done, change);
}

void Mechanics::rest_at(double position, Instant now) {
    begin(now);
    at_ = {position, 0, 0};
    rest();
}
void Mechanics::hold(bool held, Instant now) {
    if (held && !held_) held_at_ = shaft(now).position;
    if (!held && held_) motor_.set(held_at_, now);
    held_ = held;
}
Instant Mechanics::end() const { return since_ + Duration{std::llround(std::ceil(end_ * 1e9))}; }
bool Mechanics::moves(Instant now) const { return now < end() || pieces_.back().from.velocity != 0; }

}  // namespace axisgate::cia402_drive::twin
