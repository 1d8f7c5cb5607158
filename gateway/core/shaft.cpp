// A position loop of second order without feed-forward: at constant speed the shaft lags by twice the time constant times the speed, and a
// demand that accelerates adds to that.
#include "gateway/core/shaft.hpp"

#include <cmath>

#include "gateway/core/specimen.hpp"

namespace axisgate {
namespace {
constexpr double step_s = 0.001;

/// Time constant of the position loop in seconds. A motor that is only weak follows with a stiff loop of 2 ms.
double loop_s(const ShaftFreedoms& f) noexcept { return std::max<double>(2, static_cast<double>(f.follow_ms)) / 1000; }

/// x'' = -x/T^2 - 2 D x'/T, from 1 and 0 and from 0 and 1, after one millisecond.
ShaftTransition first_transition(double period, double damping) noexcept {
    const double w = 1 / period, fades = damping * w, away = damping * damping - 1;
    double cosine = 0, sine_by_frequency = 0;  // both with exp(-fades * t)
    if (std::abs(away) < 1e-9) {
        cosine = std::exp(-fades * step_s);
        sine_by_frequency = step_s * cosine;
    } else if (away < 0) {
        const double f = w * std::sqrt(-away), e = std::exp(-fades * step_s);
        cosine = e * std::cos(f * step_s);
        sine_by_frequency = e * std::sin(f * step_s) / f;
    } else {
        const double f = w * std::sqrt(away), slow = std::exp((f - fades) * step_s), fast = std::exp((-f - fades) * step_s);
        cosine = (slow + fast) / 2;
        sine_by_frequency = (slow - fast) / (2 * f);
    }
    return {cosine + fades * sine_by_frequency, sine_by_frequency, -w * w * sine_by_frequency, cosine - fades * sine_by_frequency};
}
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

Shaft::Shaft(const ShaftFreedoms& f, std::uint64_t seed)
    : differs_(!f.none()),
      loop_(f.follow_ms != 0 || f.most_acceleration != 0),
      remembers_(loop_ || f.friction_increments != 0 || f.backlash_increments != 0),
      period_(loop_s(f)),
      damping_(static_cast<double>(std::max<std::int64_t>(1, f.damping_percent)) / 100),
      most_(static_cast<double>(f.most_acceleration)),
      friction_(static_cast<double>(f.friction_increments)),
      play_(static_cast<double>(f.backlash_increments) / 2),
      drift_(static_cast<double>(f.drift_increments)),
      noise_span_(f.noise_increments == 0 ? 0 : static_cast<std::uint64_t>(2 * f.noise_increments + 1)),
      noise_(specimen_place(seed, "noise")) {
    if (!loop_) return;
    Transitions all;
    const ShaftTransition one = first_transition(period_, damping_);
    ShaftTransition so_far;
    for (ShaftTransition& t : all) {
        t.position_of_position =
            one.position_of_position * so_far.position_of_position + one.position_of_velocity * so_far.velocity_of_position;
        t.position_of_velocity =
            one.position_of_position * so_far.position_of_velocity + one.position_of_velocity * so_far.velocity_of_velocity;
        t.velocity_of_position =
            one.velocity_of_position * so_far.position_of_position + one.velocity_of_velocity * so_far.velocity_of_position;
        t.velocity_of_velocity =
            one.velocity_of_position * so_far.position_of_velocity + one.velocity_of_velocity * so_far.velocity_of_velocity;
        so_far = t;
    }
    transitions_ = std::make_shared<const Transitions>(all);
}

void Shaft::set(double position, Instant now) {
    now_ = {on_grid(now), position, 0, position, position, 0, 0};
    firm_ = now_;
    off_since_ = never;
}

void Shaft::shift(double by) noexcept {
    for (ShaftPoint* p : {&firm_, &now_}) {
        p->position += by;
        p->load += by;
        p->demand += by;
    }
    drift_from_ += by;
}

double Shaft::lack(const ShaftPoint& p) const noexcept { return std::abs(p.demand - p.position - 2 * damping_ * period_ * p.velocity); }

void Shaft::skip_to(Instant at, double demand) noexcept {
    firm_ = now_;
    firm_.at = at;
    if (demand == firm_.demand && firm_.velocity == 0) return;
    firm_ = {at, demand, 0, demand, demand, 0, 0};
}

/// The steady movement that belongs to a demand of second order is of second order, too; the rest of the movement is that of the
/// undisturbed loop.
void Shaft::move_freely(ShaftPoint& p, std::size_t milliseconds, double half_way, double demand) const noexcept {
    const double t = static_cast<double>(milliseconds) * step_s;
    const double first = half_way - p.demand, second = demand - half_way;
    const double c = 2 * (second - first) / (t * t), slope = (3 * first - second) / t;  // demand: p.demand + slope t + c t^2
    const double lag = 2 * damping_ * period_, b = slope - 2 * lag * c, a = p.demand - lag * b - 2 * period_ * period_ * c;
    const ShaftTransition& by = (*transitions_)[milliseconds - 1];
    const double x = p.position - a, v = p.velocity - b;
    p.position = a + (b + c * t) * t + by.position_of_position * x + by.position_of_velocity * v;
    p.velocity = b + 2 * c * t + by.velocity_of_position * x + by.velocity_of_velocity * v;
    p.demand_velocity = (3 * second - first) / t;
    p.demand = demand;
    p.at += static_cast<std::int64_t>(milliseconds) * step;
}

double Shaft::acceleration_wanted(const ShaftPoint& p) const noexcept {
    return (p.demand - p.position) / (period_ * period_) - 2 * damping_ / period_ * p.velocity;
}

/// The motor's force does not suffice for the loop, or it would not suffice to stop at the demand from the speed that the loop wants.
bool Shaft::limited(const ShaftPoint& p) const noexcept {
    if (std::abs(acceleration_wanted(p)) > most_) return true;
    const double error = p.demand - p.position, wanted = std::abs(error) / (2 * damping_ * period_);
    const double away = std::max(0.0, error < 0 ? -p.demand_velocity : p.demand_velocity);
    return wanted > away && (wanted - away) * (wanted - away) > 2 * most_ * std::abs(error);
}

void Shaft::settle(ShaftPoint& p) const noexcept {
    if (p.demand_velocity != 0 || std::abs(p.demand - p.position) >= 0.01 || std::abs(p.velocity) >= 0.1) return;
    p.position = p.demand;
    p.velocity = 0;
}

bool Shaft::leap(ShaftPoint& p, std::size_t milliseconds, double half_way, double demand) const noexcept {
    if (!loop_) {
        const double middle = std::clamp(p.position, half_way - friction_, half_way + friction_);
        const double t = static_cast<double>(milliseconds) * step_s;
        p.position = middle;
        drag_load(p);
        p.position = std::clamp(middle, demand - friction_, demand + friction_);
        p.velocity = 2 * (p.position - middle) / t;
        p.demand_velocity = 2 * (demand - half_way) / t;
        p.demand = demand;
        p.at += static_cast<std::int64_t>(milliseconds) * step;
        drag_load(p);
        return true;
    }
    if (p.velocity == 0 && friction_ > 0 && std::abs(p.demand - p.position) <= friction_) return false;
    if (most_ > 0 && limited(p)) return false;
    const double before = p.velocity;
    move_freely(p, milliseconds, half_way, demand);
    if (most_ > 0) {
        if (limited(p)) return false;
        p.force = std::min(1.0, std::abs(acceleration_wanted(p)) / most_);
    }
    const bool stops = friction_ > 0 && p.demand_velocity == 0 && std::abs(p.velocity) <= friction_ / period_;
    if (stops && std::abs(p.demand - p.position) <= friction_) return false;
    if (play_ > 0 && before * p.velocity < 0) return false;  // it has turned back on the way
    settle(p);
    drag_load(p);
    return true;
}

/// One millisecond. A motor of finite force limits the speed that its loop wants to the one from which it can still stop at its demand,
/// because without that limit it would swing around it for minutes.
void Shaft::one_step(ShaftPoint& p, double demand) const noexcept {
    const double half_way = (p.demand + demand) / 2;
    if (!loop_) return (void)leap(p, 1, half_way, demand);
    const double error = demand - p.position;
    const bool creeps = demand == p.demand && std::abs(p.velocity) <= friction_ / period_;
    if ((p.velocity == 0 || creeps) && std::abs(error) <= friction_) {
        p.demand_velocity = (demand - p.demand) / step_s;
        p.demand = demand;
        p.velocity = p.force = 0;
        p.at += step;
        return drag_load(p);
    }
    const ShaftPoint from = p;
    move_freely(p, 1, half_way, demand);
    if (most_ > 0) {
        const double left = demand - p.position, wanted = left / (2 * damping_ * period_);
        const double stops_from = std::sqrt(2 * most_ * std::abs(left));
        const double away = std::max(0.0, left < 0 ? -p.demand_velocity : p.demand_velocity);
        double a = (p.velocity - from.velocity) / step_s;
        const bool brakes = std::abs(wanted) > away + stops_from;
        if (brakes) {  // a speed loop towards the limit, integrated implicitly, which is stable for every time constant and damping
            const double speed_loop = 2 * damping_ / period_;
            a = speed_loop * (std::copysign(away + stops_from, wanted) - from.velocity) / (1 + speed_loop * step_s);
        }
        p.force = std::min(1.0, std::abs(a) / most_);
        if (brakes || std::abs(a) > most_) {
            p.velocity = from.velocity + std::clamp(a, -most_, most_) * step_s;
            p.position = from.position + p.velocity * step_s;
        }
    }
    settle(p);
    drag_load(p);
}

void Shaft::advance_without_power(Instant now) {
    if (off_since_ == never) {
        off_since_ = now_.at;
        drift_from_ = now_.position;
    }
    now_.velocity = now_.force = now_.demand_velocity = 0;
    if (now > now_.at) {
        now_.at = on_grid(now);
        constexpr double time_constant_s = 0.3;
        const double before = now_.position;
        if (drift_ != 0) now_.position = drift_from_ + drift_ * (1 - std::exp(-seconds(now_.at - off_since_) / time_constant_s));
        now_.load += now_.position - before;
        now_.demand = now_.position;
    }
    firm_ = now_;
}

double Shaft::shown() const noexcept {
    if (noise_span_ == 0) return now_.load;
    const std::uint64_t draw = specimen_draw_at(noise_, static_cast<std::uint64_t>(ns_of(now_.at))) % noise_span_;
    return now_.load + static_cast<double>(draw) - static_cast<double>(noise_span_ / 2);
}

}  // namespace axisgate
