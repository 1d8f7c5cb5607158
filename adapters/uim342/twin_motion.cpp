// Planning and evaluation of trapezoids and triangles with a cut-in speed.
// In: state, target, ramps. Out: profiles.
// Never allocates.
#include "adapters/uim342/twin_motion.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::uim342::twin {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// Speed -> distance that a ramp between two speeds takes; 0 without a ramp or where there is nothing to lose.
double ramp_distance(double high, double low, double rate) noexcept {
    return high > low && rate < no_ramp ? (high * high - low * low) / (2 * rate) : 0;
}

Instant later(Instant start, double seconds) noexcept {
    const double room = static_cast<double>((never - start).count());
    const double ns = std::ceil(seconds * 1e9 - 1e-3);  // the subtraction keeps 3.000 s from becoming 3.000000001 s by a rounding
    return ns < room ? start + Duration{static_cast<std::int64_t>(ns)} : never;
}

}  // namespace

Profile Profile::rest(double position) noexcept {
    Profile p;
    p.last_.position = position;
    p.end_position_ = position;
    return p;
}

void Profile::add(double duration, double velocity, double acceleration) noexcept {
    if (!(duration > 0) || count_ == capacity) return;
    segments_[count_++] = {length_, duration, last_.position, velocity, acceleration, true};
    length_ += duration;
    if (duration < endless) {
        last_.position += velocity * duration + acceleration * duration * duration / 2;
        last_.velocity = velocity + acceleration * duration;
    } else {
        last_.velocity = velocity;
    }
}

/// Slows down to `to_speed` without changing the direction; below the cut-in speed there is no ramp, only the step [L803-805].
void Profile::brake(double to_speed, double rate, double cut_in) noexcept {
    const double direction = last_.velocity < 0 ? -1 : 1;
    const double from = std::abs(last_.velocity);
    const double floor = std::max(to_speed, cut_in);
    if (from > floor && rate < no_ramp) add((from - floor) / rate, direction * from, -direction * rate);
    last_.velocity = direction * to_speed;
}

/// From rest: `distance` pulses (or for ever) in `direction`, preceded by the backlash if the direction changes.
void Profile::leave_rest(int direction, double speed, double distance, const Ramps& ramps) noexcept {
    const double slack = ramps.last_direction == -direction ? ramps.backlash : 0;
    const std::size_t first = count_;
    last_.velocity = direction * std::min(ramps.cut_in, speed);
    if (distance < endless) {
        go_on(direction, speed, distance + slack, ramps);
    } else {
        const double from = std::abs(last_.velocity);
        if (speed > from && ramps.acceleration < no_ramp)
            add((speed - from) / ramps.acceleration, direction * from, direction * ramps.acceleration);
        add(endless, direction * speed, 0);
    }
    if (slack > 0) take_up_backlash(first, slack);
}

/// Moving (or starting) in the right direction with a stop possible within `distance`: up or down to the speed, along, down to the end.
void Profile::go_on(int direction, double speed, double distance, const Ramps& ramps) noexcept {
    const double a = ramps.acceleration;
    double d = ramps.deceleration;
    double from = std::abs(last_.velocity);
    const double low = std::min(ramps.cut_in, speed);

    // A stop that just fits (the same target again while braking for it) must fit exactly: the rate gives way, not the target.
    if (ramp_distance(from, ramps.cut_in, d) > distance) d = (from * from - ramps.cut_in * ramps.cut_in) / (2 * distance);

    if (from > speed) {
        const double floor = std::max(speed, ramps.cut_in);
        distance -= ramp_distance(from, floor, d);
        if (from > floor && d < no_ramp) add((from - floor) / d, direction * from, -direction * d);
        from = speed;
    } else {
        from = std::max(from, low);
    }
    // Here from <= speed. Peak of the triangle, held down to the speed.
    double peak = speed;
    if (speed > low) {
        double square = speed * speed;
        if (a < no_ramp && d < no_ramp) {
            square = (2 * a * d * distance + d * from * from + a * low * low) / (a + d);
        } else if (a < no_ramp) {
            square = 2 * a * distance + from * from;
        } else if (d < no_ramp) {
            square = 2 * d * distance + low * low;
        }
        peak = std::clamp(std::sqrt(std::max(square, 0.0)), from, speed);
    }
    distance -= ramp_distance(peak, from, a) + ramp_distance(peak, low, d);
    if (peak > from && a < no_ramp) add((peak - from) / a, direction * from, direction * a);
    if (distance > 0) add(distance / peak, direction * peak, 0);
    if (peak > low && d < no_ramp) add((peak - low) / d, direction * peak, -direction * d);
    last_.velocity = 0;
}

/// The first `pulses` of the motor since piece `first` are not counted; later pieces begin where the counter stood.
void Profile::take_up_backlash(std::size_t first, double pulses) noexcept {
    const double stand = segments_[first].position;
    double left = pulses;
    for (std::size_t i = first; i < count_; ++i) {
        Segment& s = segments_[i];
        if (left <= 0) {
            s.position -= (s.velocity < 0 || (s.velocity == 0 && s.acceleration < 0)) ? -pulses : pulses;
            continue;
        }
        const double v = std::abs(s.velocity);
        // Pieces of one leg have one direction, and a piece's speed and acceleration share its sign unless it brakes.
        const bool negative = s.velocity < 0 || (s.velocity == 0 && s.acceleration < 0);
        const double a = negative ? -s.acceleration : s.acceleration;
        const double whole = s.duration < endless ? v * s.duration + a * s.duration * s.duration / 2 : endless;
        if (whole <= left) {
            left -= whole;
            s.position = stand;
            s.counted = false;
            continue;
        }
        const double root = std::sqrt(std::max(v * v + 2 * a * left, 0.0));
        const double t = std::min(2 * left / (v + root), s.duration);  // this form of the quadratic is good for a = 0 too
        left = 0;
        if (count_ == capacity || !(t > 0) || !(t < s.duration)) {
            s.position = stand;
            continue;
        }
        for (std::size_t k = count_; k > i + 1; --k)
            segments_[k] = segments_[k - 1];
        ++count_;
        Segment& rest = segments_[i + 1];
        rest = s;
        rest.begin = s.begin + t;
        rest.duration = s.duration - t;
        rest.velocity = s.velocity + s.acceleration * t;
        rest.position = stand;
        s.duration = t;
        s.position = stand;
        s.counted = false;
        ++i;  // `rest` is done
    }
}

void Profile::finish() noexcept {
    end_ = length_ < endless ? later(start_, length_) : never;
    if (!reaches_target_) end_position_ = std::round(last_.position);
}

Profile Profile::jog(Instant now, MotionState from, double velocity, const Ramps& ramps) noexcept {
    Profile p;
    p.start_ = now;
    p.last_ = from;
    const double speed = std::abs(velocity);
    const int direction = velocity < 0 ? -1 : 1;
    if (speed > 0 && from.velocity * direction > 0) {
        const double present = std::abs(from.velocity);
        if (present > speed) {
            p.brake(speed, ramps.deceleration, ramps.cut_in);
        } else {
            const double begin = std::max(present, std::min(ramps.cut_in, speed));
            if (speed > begin && ramps.acceleration < no_ramp)
                p.add((speed - begin) / ramps.acceleration, direction * begin, direction * ramps.acceleration);
        }
        p.add(endless, velocity, 0);
    } else {
        Ramps after = ramps;
        if (from.velocity != 0) {
            after.last_direction = from.velocity < 0 ? -1 : 1;
            p.brake(0, ramps.deceleration, ramps.cut_in);
        }
        if (speed > 0) p.leave_rest(direction, speed, endless, after);
    }
    p.finish();
    return p;
}

Profile Profile::move(Instant now, MotionState from, double target, double speed, const Ramps& ramps) noexcept {
    const bool there = from.velocity == 0 && from.position == target;
    if (!(speed > 0) && !there) return stop(now, from, ramps.deceleration, ramps.cut_in);
    Profile p;
    p.start_ = now;
    p.last_ = from;
    p.reaches_target_ = true;
    p.end_position_ = target;
    Ramps after = ramps;
    if (from.velocity != 0) {
        const int direction = from.velocity < 0 ? -1 : 1;
        const double distance = direction * (target - from.position);
        // Half a pulse of tolerance: the counter cannot show less, and a target repeated while braking for it stays reachable.
        if (distance > 0 && distance + 0.5 >= ramp_distance(std::abs(from.velocity), ramps.cut_in, ramps.deceleration)) {
            p.go_on(direction, speed, distance, ramps);
            p.finish();
            return p;
        }
        after.last_direction = direction;
        p.brake(0, ramps.deceleration, ramps.cut_in);
    }
    const double distance = target - p.last_.position;
    if (distance != 0) p.leave_rest(distance < 0 ? -1 : 1, speed, std::abs(distance), after);
    p.finish();
    return p;
}

Profile Profile::stop(Instant now, MotionState from, double rate, double cut_in) noexcept {
    Profile p;
    p.start_ = now;
    p.last_ = from;
    if (from.velocity != 0) p.brake(0, rate > 0 ? rate : no_ramp, cut_in);
    p.finish();
    return p;
}

MotionState Profile::at(Instant now) const noexcept {
    if (now >= end_ || count_ == 0) return {end_position_, 0};
    const double t = std::max(seconds(now - start_), 0.0);
    std::size_t i = count_ - 1;
    while (i > 0 && t < segments_[i].begin)
        --i;
    const Segment& s = segments_[i];
    const double local = std::min(t - s.begin, s.duration);
    return {s.position_at(local), s.velocity_at(local)};
}

int Profile::last_direction() const noexcept {
    if (count_ == 0) return 0;
    const Segment& s = segments_[count_ - 1];
    const double v = s.velocity != 0 ? s.velocity : s.acceleration;
    return v < 0 ? -1 : 1;
}

void Profile::shift(double pulses) noexcept {
    for (std::size_t i = 0; i < count_; ++i)
        segments_[i].position -= pulses;
    last_.position -= pulses;
    end_position_ -= pulses;
}

Instant Profile::first_departure(Instant from, double centre, double distance) const noexcept {
    if (from >= end_) return std::abs(end_position_ - centre) >= distance ? from : never;
    const double now = std::max(seconds(from - start_), 0.0);
    if (std::abs(at(from).position - centre) >= distance) return from;
    for (std::size_t i = 0; i < count_; ++i) {
        const Segment& s = segments_[i];
        if (!s.counted || now >= s.begin + s.duration) continue;
        const double skip = std::max(now - s.begin, 0.0);
        const double p = s.position_at(skip) - centre;
        const double v = s.velocity_at(skip);
        const double forward = v != 0 ? v : s.acceleration;
        if (forward == 0) continue;
        // A piece never changes its direction, so only the bound ahead can be crossed; distance to it along the direction:
        const double sign = forward < 0 ? -1 : 1;
        const double gap = distance - sign * p;
        const double speed = std::abs(v);
        const double a = sign * s.acceleration;
        const double inside = speed * speed + 2 * a * gap;
        if (inside < 0) continue;
        const double sum = speed + std::sqrt(inside);
        if (!(sum > 0)) continue;
        const double t = std::max(2 * gap / sum, 0.0);
        if (t <= s.duration - skip) return std::max(from, later(start_, s.begin + skip + t));
    }
    return std::abs(end_position_ - centre) >= distance && end_ != never ? end_ : never;
}

Instant Profile::first_faster(Instant from, double limit) const noexcept {
    if (from >= end_) return never;
    const double now = std::max(seconds(from - start_), 0.0);
    for (std::size_t i = 0; i < count_; ++i) {
        const Segment& s = segments_[i];
        if (now >= s.begin + s.duration) continue;
        const double skip = std::max(now - s.begin, 0.0);
        const double speed = std::abs(s.velocity_at(skip));
        if (speed > limit) return std::max(from, later(start_, s.begin + skip));
        // A piece does not change its direction, so its speed grows if speed and acceleration agree.
        const double rate = s.velocity_at(skip) * s.acceleration >= 0 ? std::abs(s.acceleration) : 0;
        if (!(rate > 0) || s.duration == endless) continue;
        const double t = (limit - speed) / rate;
        if (t < s.duration - skip && speed + rate * (s.duration - skip) > limit) return std::max(from, later(start_, s.begin + skip + t));
    }
    return never;
}

}  // namespace axisgate::uim342::twin
