// The shaft of a specimen between the pulses and the encoder. In closed loop it lags as its position loop does, and a motor that lacks
// force by the stall tolerance has stalled. In open loop the rotor follows within a part of a pole; beyond two full steps it falls out of
// step, stands until the pulses stand, and is caught by the next pole: four full steps are one pole of the usual 50.
#include <algorithm>
#include <cmath>

#include "adapters/uim342/twin/axis_shaft.hpp"

namespace axisgate::uim342::twin {

double AxisShaft::seat(const Axis& a, Instant now) noexcept {
    if (!a.mechanics_.closed_loop) return a.profile_.at(now).position;
    return a.coasting_ ? a.coast_.at(now).position : a.held_ ? a.held_at_ : lags(a) ? a.real_.load() : a.profile_.at(now).position;
}

void AxisShaft::fit(Instant now) noexcept {
    a_.real_.set(a_.profile_.at(now).position, now);
    a_.out_of_step_ = a_.overloaded_ = false;
    a_.followed_ = now;
}

void Axis::follow(Instant now) noexcept {
    if (!real_.differs() || coasting_ || now <= followed_) return;
    if (held_ || (!driver_on_ && !was_on_)) {
        followed_ = now;
        return;
    }
    if (driver_on_) return AxisShaft(*this).follow_pulses(now);
    real_.advance_without_power(now);
    followed_ = now;
}

void AxisShaft::follow_pulses(Instant now) noexcept {
    const auto demand = [this](Instant t) { return a_.profile_.at(t).position; };
    if (a_.free_.most_acceleration == 0) {
        a_.real_.advance(now, demand);
        a_.followed_ = now;
        return;
    }
    const double most = a_.mechanics_.closed_loop ? static_cast<double>(a_.mechanics_.tolerance) : 2 * a_.mechanics_.pulses_per_turn / 200;
    const auto fails = [&](const ShaftPoint& p) { return p.force >= 1 && a_.real_.lack(p) >= most; };
    if (a_.mechanics_.closed_loop) {
        const bool looks = a_.stall_armed_ && !a_.overloaded_;
        if (looks && a_.real_.advance_until(now, demand, fails) != never) a_.overloaded_ = true;
        a_.real_.advance(now, demand);
    } else {
        if (!a_.out_of_step_) a_.out_of_step_ = a_.real_.advance_until(now, demand, fails) != never;
        if (a_.out_of_step_) stand_until(now);
    }
    a_.followed_ = now;
}

/// Out of step it stands until the pulses do; then the next pole catches it.
void AxisShaft::stand_until(Instant now) noexcept {
    const Instant standstill = std::max(a_.profile_.end(), a_.real_.point().at);
    a_.real_.set(a_.real_.position(), std::min(now, standstill));
    if (standstill > now) return;
    slip_poles(standstill);
    a_.real_.advance(now, [this](Instant t) { return a_.profile_.at(t).position; });
}

void AxisShaft::slip_poles(Instant now) noexcept {
    const double pole = 4 * a_.mechanics_.pulses_per_turn / 200;
    const double behind = std::round((a_.profile_.at(now).position - a_.real_.position()) / pole) * pole;
    a_.slip_ -= behind;
    a_.real_.set(a_.real_.position() + behind, now);
    a_.out_of_step_ = false;
}

void AxisShaft::drift_ends(Instant now) noexcept {
    if (!lags(a_) || !a_.was_on_) return;
    if (a_.mechanics_.closed_loop) {
        a_.rest_at(std::round(a_.real_.load()));
    } else {
        a_.slip_ += a_.real_.load() - a_.profile_.end_position();
    }
    fit(now);
}

}  // namespace axisgate::uim342::twin
