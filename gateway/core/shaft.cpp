// A position loop of second order without feed-forward, integrated with a fixed step: at constant speed the shaft lags by twice the time
// constant times the speed, and a demand that accelerates adds to that.
#include "gateway/core/shaft.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/core/specimen.hpp"

namespace axisgate {

ShaftFreedoms shaft_freedoms(const FreedomValues& values) {
    ShaftFreedoms f;
    f.follow_ms = freedom(values, "follow_ms", f.follow_ms);
    f.damping_percent = freedom(values, "damping_percent", f.damping_percent);
    f.most_acceleration = freedom(values, "most_acceleration", f.most_acceleration);
    f.friction_increments = freedom(values, "friction_increments", f.friction_increments);
    f.backlash_increments = freedom(values, "backlash_increments", f.backlash_increments);
    f.noise_increments = freedom(values, "noise_increments", f.noise_increments);
    f.drift_increments = freedom(values, "drift_increments", f.drift_increments);
    return f;
}

void Shaft::set(double position, Instant now) {
    x_ = load_ = demand_ = position;
    v_ = demand_velocity_ = force_ = 0;
    last_ = time_zero + (now - time_zero) / step * step;
    off_since_ = never;
}

void Shaft::begin_gap(Instant now) {
    off_since_ = never;
    if (now - last_ > longest_gap) last_ = time_zero + (now - longest_gap - time_zero) / step * step;
}

void Shaft::one_step(double demand) {
    constexpr double dt = 0.001;
    demand_velocity_ = (demand - demand_) / dt;
    demand_ = demand;
    if (free_.follow_ms == 0 && free_.most_acceleration == 0) {
        v_ = demand_velocity_;
        if (std::abs(demand - x_) > static_cast<double>(free_.friction_increments) || demand_velocity_ != 0) x_ = demand;
        return drag_load();
    }
    // A motor that is only weak follows with a stiff loop of 2 ms.
    const double period = std::max<double>(2, static_cast<double>(free_.follow_ms)) / 1000;
    const double stiffness = 1 / period, damping = static_cast<double>(free_.damping_percent) / 100;
    const double error = demand - x_;
    const double friction = static_cast<double>(free_.friction_increments);
    if (demand_velocity_ == 0 && std::abs(error) <= friction && std::abs(v_) <= friction * stiffness) {
        v_ = force_ = 0;
        return drag_load();
    }
    double acceleration = stiffness * stiffness * error - 2 * damping * stiffness * v_;
    if (free_.most_acceleration != 0) {
        const double most = static_cast<double>(free_.most_acceleration);
        force_ = std::min(1.0, std::abs(acceleration) / most);
        acceleration = std::clamp(acceleration, -most, most);
    }
    v_ += acceleration * dt;
    x_ += v_ * dt;
    if (demand_velocity_ == 0 && std::abs(demand - x_) < 0.01 && std::abs(v_) < 0.1) {
        x_ = demand;
        v_ = 0;
    }
    drag_load();
}

void Shaft::drag_load() noexcept {
    const double half = static_cast<double>(free_.backlash_increments) / 2;
    load_ = std::clamp(load_, x_ - half, x_ + half);
}

void Shaft::advance_without_power(Instant now) {
    if (off_since_ == never) {
        off_since_ = last_;
        drift_from_ = x_;
    }
    v_ = force_ = 0;
    if (now <= last_) return;
    last_ = time_zero + (now - time_zero) / step * step;
    constexpr double time_constant_s = 0.3;
    const double before = x_;
    x_ = drift_from_ + static_cast<double>(free_.drift_increments) * (1 - std::exp(-seconds(last_ - off_since_) / time_constant_s));
    load_ += x_ - before;
    demand_ = x_;
    demand_velocity_ = 0;
}

double Shaft::shown() const noexcept {
    if (free_.noise_increments == 0) return load_;
    const auto span = static_cast<std::uint64_t>(2 * free_.noise_increments + 1);
    const auto draw = specimen_draw(seed_, "noise", static_cast<std::uint64_t>(ns_of(last_))) % span;
    return load_ + static_cast<double>(draw) - static_cast<double>(free_.noise_increments);
}

}  // namespace axisgate
