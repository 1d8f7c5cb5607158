// The shaft of a specimen between the pulses and the encoder. In closed loop it lags as its position loop does, and a motor that lacks
// force by the stall tolerance has stalled. In open loop the rotor follows within a part of a pole; beyond two full steps it falls out of
// step, stands until the pulses stand, and is caught by the next pole: four full steps are one pole of the usual 50.
#include <algorithm>
#include <cmath>

#include "adapters/uim342/twin/axis.hpp"

namespace axisgate::uim342::twin {

/// The shaft rests at the end of the profile.
void Axis::fit_shaft(Instant now) noexcept {
    real_.set(profile_.at(now).position, now);
    out_of_step_ = overloaded_ = false;
    followed_ = now;
}

void Axis::follow(Instant now) noexcept {
    if (!real_.differs() || coasting_ || now <= followed_) return;
    if (held_ || (!driver_on_ && !was_on_)) {
        followed_ = now;
        return;
    }
    if (driver_on_) return follow_pulses(now);
    real_.advance_without_power(now);
    followed_ = now;
}

void Axis::follow_pulses(Instant now) noexcept {
    const auto demand = [this](Instant t) { return profile_.at(t).position; };
    if (free_.most_acceleration == 0) {
        real_.advance(now, demand);
        followed_ = now;
        return;
    }
    if (now - followed_ > Shaft::longest_gap) followed_ = now - Shaft::longest_gap;
    for (;;) {
        const Instant next = time_zero + ((followed_ - time_zero) / Shaft::step + 1) * Shaft::step;
        if (next > now) return;
        followed_ = next;
        if (out_of_step_) {
            real_.set(real_.position(), next);
            if (profile_.at(next).velocity == 0) slip_poles(next);
            continue;
        }
        real_.advance(next, demand);
        const bool saturated = real_.force() >= 1;
        if (mechanics_.closed_loop)
            overloaded_ = overloaded_ || (saturated && stall_armed_ && real_.lack() >= mechanics_.tolerance);
        else
            out_of_step_ = saturated && real_.lack() > 2 * mechanics_.pulses_per_turn / 200;
    }
}

void Axis::slip_poles(Instant now) noexcept {
    const double pole = 4 * mechanics_.pulses_per_turn / 200;
    const double behind = std::round((profile_.at(now).position - real_.position()) / pole) * pole;
    slip_ -= behind;
    real_.set(real_.position() + behind, now);
    out_of_step_ = false;
}

/// The driver catches a shaft that has drifted: in closed loop its place becomes the demand, in open loop nobody has counted it.
void Axis::drift_ends(Instant now) noexcept {
    if (!lags() || !was_on_) return;
    if (mechanics_.closed_loop) {
        rest_at(std::round(real_.load()));
    } else {
        slip_ += real_.load() - profile_.end_position();
    }
    fit_shaft(now);
}

}  // namespace axisgate::uim342::twin
