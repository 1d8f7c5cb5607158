// The trapezoid. In: speeds and places. Out: the same at an instant. Never divides by what may be zero.
#include "adapters/pacontrol/twin/path.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::pacontrol::twin {
namespace {
constexpr double smallest = 1e-9;

Duration of_seconds(double s) noexcept {
    return Duration{static_cast<std::int64_t>(std::ceil(std::clamp(s, 0.0, longest_motion_s) * 1e9 - 1e-3))};
}
}  // namespace

void Path::finish(Instant t0) noexcept {
    t0_ = t0;
    end_ = t0 + of_seconds(t1_ + t2_ + t3_);
}

Path Path::to(double x0, double x1, double entry, double speed, double start_stop, double acceleration, Instant t0) {
    Path p;
    p.x0_ = x0;
    p.x1_ = x1;
    p.direction_ = x1 < x0 ? -1 : 1;
    const double d = std::abs(x1 - x0);
    if (d <= 0) {
        p.finish(t0);
        return p;
    }
    const double w = std::max(speed, smallest);
    p.a_ = std::max(acceleration, smallest);
    p.exit_ = std::clamp(start_stop, 0.0, w);
    p.entry_ = std::max(entry, p.exit_);
    const double u = p.entry_;
    const double e = p.exit_;
    const double direct = (u * u - e * e) / (2 * p.a_);  // way that slowing down from here takes
    if (direct >= d) {
        p.a_ = std::max((u * u - e * e) / (2 * d), smallest);  // too short for the ramp: brakes as hard as it must
        p.peak_ = u;
    } else if (u > w) {
        p.peak_ = w;
    } else {
        p.peak_ = std::min(w, std::sqrt((2 * p.a_ * d + u * u + e * e) / 2));
    }
    p.peak_ = std::max(p.peak_, smallest);
    p.t1_ = std::abs(p.peak_ - u) / p.a_;
    p.d1_ = (u + p.peak_) / 2 * p.t1_;
    p.t3_ = std::max(0.0, (p.peak_ - e) / p.a_);
    const double d3 = (p.peak_ + e) / 2 * p.t3_;
    p.d2_ = std::max(0.0, d - p.d1_ - d3);
    p.t2_ = p.d2_ / p.peak_;
    p.finish(t0);
    return p;
}

Path Path::halt(double x0, double direction, double entry, double start_stop, double acceleration, Instant t0) {
    Path p;
    p.x0_ = x0;
    p.direction_ = direction;
    p.a_ = std::max(acceleration, smallest);
    p.entry_ = p.peak_ = std::max(entry, 0.0);
    p.exit_ = std::clamp(start_stop, 0.0, p.peak_);
    p.t3_ = (p.peak_ - p.exit_) / p.a_;
    p.x1_ = x0 + direction * (p.peak_ + p.exit_) / 2 * p.t3_;
    p.finish(t0);
    return p;
}

double Path::position(Instant t) const noexcept {
    if (t >= end_) return x1_;
    const double s = std::max(0.0, seconds(t - t0_));
    double way = 0;
    if (s < t1_) {
        const double sign = peak_ >= entry_ ? 1 : -1;
        way = entry_ * s + sign * a_ * s * s / 2;
    } else if (s < t1_ + t2_) {
        way = d1_ + peak_ * (s - t1_);
    } else {
        const double r = std::min(s - t1_ - t2_, t3_);
        way = d1_ + d2_ + peak_ * r - a_ * r * r / 2;
    }
    return x0_ + direction_ * std::min(way, std::abs(x1_ - x0_));
}

double Path::velocity(Instant t) const noexcept {
    if (t >= end_ || t < t0_) return 0;
    const double s = std::max(0.0, seconds(t - t0_));
    if (s < t1_) return direction_ * (entry_ + (peak_ >= entry_ ? a_ : -a_) * s);
    if (s < t1_ + t2_) return direction_ * peak_;
    return direction_ * std::max(exit_, peak_ - a_ * (s - t1_ - t2_));
}

Instant Path::when(double x) const noexcept {
    const double q = (x - x0_) * direction_;
    if (q < 0 || q > std::abs(x1_ - x0_)) return never;
    if (q <= 0) return t0_;
    double s = 0;
    if (q < d1_) {
        const double sign = peak_ >= entry_ ? 1 : -1;
        s = 2 * q / (entry_ + std::sqrt(std::max(0.0, entry_ * entry_ + sign * 2 * a_ * q)));
    } else if (q < d1_ + d2_) {
        s = t1_ + (q - d1_) / peak_;
    } else {
        const double r = q - d1_ - d2_;
        s = t1_ + t2_ + 2 * r / (peak_ + std::sqrt(std::max(0.0, peak_ * peak_ - 2 * a_ * r)));
    }
    return std::min(end_, t0_ + of_seconds(s));
}

}  // namespace axisgate::pacontrol::twin
