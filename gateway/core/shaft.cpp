// A position loop of second order without feed-forward, integrated with a fixed step: at constant speed the shaft lags by twice the time
// constant times the speed, and a demand that accelerates adds to that.
#include "gateway/core/shaft.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/core/specimen.hpp"

namespace axisgate {
namespace {
constexpr double step_s = 0.001;

/// Time constant of the position loop in seconds. A motor that is only weak follows with a stiff loop of 2 ms.
double loop_s(const ShaftFreedoms& f) noexcept { return std::max<double>(2, static_cast<double>(f.follow_ms)) / 1000; }
}  // namespace

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
    last_ = on_grid(now);
    off_since_ = never;
}

void Shaft::shift(double by) noexcept {
    x_ += by;
    load_ += by;
    demand_ += by;
    drift_from_ += by;
}

double Shaft::lack() const noexcept {
    const double damping = static_cast<double>(std::max<std::int64_t>(1, free_.damping_percent)) / 100;
    return std::abs(demand_ - x_ - 2 * damping * loop_s(free_) * v_);
}

void Shaft::skip_to(double demand) noexcept {
    if (demand == demand_ && v_ == 0) return;
    x_ = load_ = demand_ = demand;
    v_ = demand_velocity_ = force_ = 0;
}

void Shaft::one_step(double demand) {
    demand_velocity_ = (demand - demand_) / step_s;
    demand_ = demand;
    const double friction = static_cast<double>(free_.friction_increments);
    if (free_.follow_ms == 0 && free_.most_acceleration == 0) {
        const double before = x_;
        x_ = std::clamp(x_, demand - friction, demand + friction);
        v_ = (x_ - before) / step_s;
        return drag_load();
    }
    const double error = demand - x_;
    const bool creeps = demand_velocity_ == 0 && std::abs(v_) <= friction / loop_s(free_);
    if ((v_ == 0 || creeps) && std::abs(error) <= friction) {
        v_ = force_ = 0;
        return drag_load();
    }
    v_ += acceleration(error) * step_s;
    x_ += v_ * step_s;
    if (demand_velocity_ == 0 && std::abs(demand - x_) < 0.01 && std::abs(v_) < 0.1) {
        x_ = demand;
        v_ = 0;
    }
    drag_load();
}

/// The loop wants a speed in proportion to the error. A motor of finite force limits it to the speed from which it can still stop at its
/// demand, because without that limit it would swing around it for minutes. The speed loop is integrated implicitly, which is stable for
/// every time constant and damping.
double Shaft::acceleration(double error) noexcept {
    const double damping = static_cast<double>(std::max<std::int64_t>(1, free_.damping_percent)) / 100;
    const double speed_loop = 2 * damping / loop_s(free_);
    double wanted = error / (2 * damping * loop_s(free_));
    const double most = static_cast<double>(free_.most_acceleration);
    if (most > 0) {
        const double stops_from = std::sqrt(2 * most * std::abs(error));
        const double away = std::max(0.0, error < 0 ? -demand_velocity_ : demand_velocity_);
        wanted = std::clamp(wanted, -away - stops_from, away + stops_from);
    }
    double a = speed_loop * (wanted - v_) / (1 + speed_loop * step_s);
    if (most > 0) {
        force_ = std::min(1.0, std::abs(a) / most);
        a = std::clamp(a, -most, most);
    }
    return a;
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
    last_ = on_grid(now);
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
