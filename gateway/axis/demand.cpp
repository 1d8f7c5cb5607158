// Computes a motion as pieces of constant acceleration, in order and without gaps of position. It never allocates, and never divides by a
// value that may be 0.
#include "gateway/axis/demand.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate {
namespace {
constexpr double endless = std::numeric_limits<double>::infinity();

double seconds_of(Duration d) noexcept { return std::chrono::duration<double>(d).count(); }

/// The distance between two speeds.
double way(double high, double low, double rate) noexcept {
    return high > low && rate < DemandRamps::at_once ? (high - low) * (high + low) / (2 * rate) : 0;
}

/// The highest speed on a way of `distance` that begins with `from`, ends with `to`, and changes from one ramp to the other.
double peak_of(double distance, double from, double to, const DemandRamps& r) noexcept {
    // distance = (w^2 - from^2) / 2a + (w^2 - to^2) / 2d
    const double up = r.acceleration < DemandRamps::at_once ? 1 / (2 * r.acceleration) : 0;
    const double down = r.deceleration < DemandRamps::at_once ? 1 / (2 * r.deceleration) : 0;
    if (up + down <= 0) return endless;
    return std::sqrt(std::max(0.0, (distance + from * from * up + to * to * down) / (up + down)));
}
}  // namespace

void Demand::rest(double position) noexcept {
    known_ = true;
    count_ = 0;
    length_ = 0;
    end_ = {position, 0};
}

void Demand::begin(Instant now) noexcept {
    const DemandState present = at(now);
    count_ = 0;
    length_ = 0;
    since_ = now;
    end_ = present;
}

void Demand::add(double seconds, double velocity, double acceleration) noexcept {
    if (!(seconds > 0) || count_ == pieces_.size()) return;
    pieces_[count_++] = {length_, end_.position, velocity, acceleration};
    length_ += seconds;
    if (seconds < endless) {
        end_.position += (velocity + acceleration * seconds / 2) * seconds;
        end_.velocity = velocity + acceleration * seconds;
    }
}

/// Slows down in the present direction: with the ramp down to the start speed, below it at once.
void Demand::brake(double to_speed, const DemandRamps& ramps) noexcept {
    const double direction = end_.velocity < 0 ? -1 : 1;
    const double from = std::abs(end_.velocity), to = std::max(to_speed, std::min(from, ramps.start_speed));
    if (from > to && ramps.deceleration < DemandRamps::at_once) {
        add((from - to) / ramps.deceleration, end_.velocity, -direction * ramps.deceleration);
    }
    end_.velocity = direction * to_speed;
}

/// Accelerates in `direction`: from rest it steps to the start speed.
void Demand::accelerate(double direction, double to_speed, const DemandRamps& ramps) noexcept {
    const double from = std::max(std::abs(end_.velocity), std::min(ramps.start_speed, to_speed));
    if (to_speed > from && ramps.acceleration < DemandRamps::at_once) {
        add((to_speed - from) / ramps.acceleration, direction * from, direction * ramps.acceleration);
    }
    end_.velocity = direction * to_speed;
}

void Demand::run(Instant now, double velocity, const DemandRamps& ramps) noexcept {
    begin(now);
    const double direction = velocity < 0 ? -1 : 1, speed = std::abs(velocity);
    if (end_.velocity * direction < 0 || speed <= 0) brake(0, ramps);
    if (speed <= 0) return;
    if (std::abs(end_.velocity) > speed) {
        brake(speed, ramps);
    } else {
        accelerate(direction, speed, ramps);
    }
    add(endless, velocity, 0);
}

void Demand::move(Instant now, double target, double speed, const DemandRamps& ramps) noexcept {
    begin(now);
    if (end_.velocity != 0) {
        const double direction = end_.velocity < 0 ? -1 : 1, ahead = direction * (target - end_.position);
        const double needed = way(std::abs(end_.velocity), ramps.start_speed, ramps.deceleration);
        // The same target may be ordered again while braking for it: a deviation by rounding counts as in time.
        if (ahead <= 0 || needed > ahead + 0.5) brake(0, ramps);
    }
    double left = std::abs(target - end_.position);
    const double direction = target < end_.position ? -1 : 1;
    const double slow = std::min(ramps.start_speed, speed);
    const double present = std::abs(end_.velocity);
    if (present > speed) {
        const double fall = way(present, std::max(speed, ramps.start_speed), ramps.deceleration);
        brake(speed, ramps);
        left -= fall;
    } else if (left > 0) {
        const double from = std::max(present, slow);
        const double peak = std::clamp(peak_of(left, from, slow, ramps), from, speed);
        left -= way(peak, from, ramps.acceleration);
        accelerate(direction, peak, ramps);
    }
    const double cruise = std::abs(end_.velocity), fall = way(cruise, slow, ramps.deceleration);
    if (cruise > 0 && left > fall) add((left - fall) / cruise, end_.velocity, 0);
    brake(0, ramps);
    end_ = {target, 0};
}

DemandState Demand::at(Instant now) const noexcept {
    const double t = std::max(0.0, seconds_of(now - since_));
    if (count_ == 0 || t >= length_) return end_;
    std::size_t i = count_ - 1;
    while (i > 0 && t < pieces_[i].begin)
        --i;
    const Piece& p = pieces_[i];
    const double s = t - p.begin;
    return {p.position + (p.velocity + p.acceleration * s / 2) * s, p.velocity + p.acceleration * s};
}

bool Demand::over(Instant now) const noexcept { return count_ == 0 || seconds_of(now - since_) >= length_; }

}  // namespace axisgate
