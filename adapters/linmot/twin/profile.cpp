// Segments of constant acceleration.
#include "adapters/linmot/twin/profile.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::linmot::twin {

void Profile::clear(Instant now, Point from, const Ramps& ramps) noexcept {
    since_ = now;
    ramps_ = {std::max(ramps.velocity, 1.0), std::max(ramps.acceleration, 1.0), std::max(ramps.deceleration, 1.0)};
    now_ = from;
    length_ = 0;
    count_ = 0;
}

void Profile::add(double length, double acceleration) noexcept {
    if (!(length > 0) || count_ == pieces_.size()) return;
    pieces_[count_++] = {length_, length, now_.position, now_.velocity, acceleration};
    length_ += length;
    now_.position += now_.velocity * length + acceleration * length * length / 2;
    now_.velocity += acceleration * length;
}

void Profile::to_velocity(double velocity, double rate) noexcept {
    const double change = velocity - now_.velocity;
    add(std::fabs(change) / rate, change < 0 ? -rate : rate);
    now_.velocity = velocity;
}

Instant Profile::instant(double seconds) const noexcept {
    constexpr double most = 9e9;  // s: the range of an Instant
    if (!(seconds < most)) return never;
    return since_ + Duration{static_cast<std::int64_t>(std::ceil(seconds * 1e9))};
}

void Profile::rest(double position, Instant now) noexcept {
    const Ramps kept = ramps_;
    clear(now, {position, 0}, kept);
    target_ = position;
    end_ = now;
}

/// From now_ on, with any velocity, so that the motion ends at the target.
void Profile::approach(double target) noexcept {
    const double a = ramps_.acceleration, d = ramps_.deceleration, vm = ramps_.velocity;
    const double way = target - now_.position;
    const double direction = way < 0 || (way == 0 && now_.velocity < 0) ? -1 : 1;
    const double u = now_.velocity * direction, distance = std::fabs(way);
    if (u < 0 || u * u / (2 * d) > distance * (1 + 1e-12) + 1e-9) {
        to_velocity(0, d);
        if (std::fabs(target - now_.position) > 1e-9) approach(target);
        return;
    }
    if (u > vm) {
        to_velocity(direction * vm, d);
        approach(target);
        return;
    }
    const double peak = std::min(vm, std::sqrt((2 * a * d * distance + d * u * u) / (a + d)));
    if (peak > u) to_velocity(direction * peak, a);
    const double rest = std::fabs(target - now_.position) - peak * peak / (2 * d);
    if (peak > 0 && rest > 0) add(rest / peak, 0);
    to_velocity(0, d);
}

void Profile::close() noexcept {
    now_.position = target_;
    now_.velocity = 0;
    end_ = instant(length_);
}

void Profile::move(Instant now, Point from, double target, const Ramps& ramps) noexcept {
    clear(now, from, ramps);
    target_ = target;
    approach(target);
    close();
}

void Profile::run(Instant now, Point from, double direction, const Ramps& ramps) noexcept {
    clear(now, from, ramps);
    if (now_.velocity * direction < 0) to_velocity(0, ramps_.deceleration);
    const bool faster = std::fabs(now_.velocity) > ramps_.velocity;
    to_velocity(direction * ramps_.velocity, faster ? ramps_.deceleration : ramps_.acceleration);
    target_ = now_.position;
    end_ = never;
}

void Profile::stop(Instant now, Point from, double deceleration) noexcept {
    Ramps r = ramps_;
    r.deceleration = deceleration;
    const Ramps kept = ramps_;
    clear(now, from, r);
    to_velocity(0, ramps_.deceleration);
    target_ = now_.position;
    close();
    ramps_ = kept;
}

Point Profile::at(Instant now) const noexcept {
    if (now >= end_) return {target_, 0};
    const double t = std::max(0.0, seconds(now - since_));
    for (std::size_t i = count_; i-- > 0;) {
        const Piece& p = pieces_[i];
        if (t < p.begin) continue;
        if (t >= p.begin + p.length) break;  // after the last segment: endless
        const double s = t - p.begin;
        return {p.position + p.velocity * s + p.acceleration * s * s / 2, p.velocity + p.acceleration * s};
    }
    if (count_ != 0 && t < pieces_[0].begin) return {pieces_[0].position, pieces_[0].velocity};
    return {now_.position + now_.velocity * (t - length_), now_.velocity};
}

std::optional<Instant> Profile::crossing(double position, bool upwards, Instant after) const noexcept {
    const double from = std::max(0.0, seconds(after - since_));
    const auto in = [&](double begin, double length, double p, double v, double a) -> std::optional<double> {
        // p + v s + a s^2/2 = position, with a velocity in the given direction
        double roots[2];
        int n = 0;
        if (std::fabs(a) < 1e-12) {
            if (v != 0) roots[n++] = (position - p) / v;
        } else if (const double q = v * v + 2 * a * (position - p); q >= 0) {
            const double r = std::sqrt(q);
            roots[n++] = (-v - r) / a;
            roots[n++] = (-v + r) / a;
            if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
        }
        for (int i = 0; i < n; ++i) {
            const double s = roots[i];
            if (!(s >= 0) || s > length || begin + s <= from) continue;
            const double speed = v + a * s;
            if (upwards ? speed > 0 : speed < 0) return begin + s;
        }
        return std::nullopt;
    };
    for (std::size_t i = 0; i < count_; ++i) {
        const Piece& p = pieces_[i];
        if (const auto t = in(p.begin, p.length, p.position, p.velocity, p.acceleration)) return instant(*t);
    }
    if (endless()) {
        if (const auto t = in(length_, 1e10, now_.position, now_.velocity, 0)) return instant(*t);
    }
    return std::nullopt;
}

}  // namespace axisgate::linmot::twin
