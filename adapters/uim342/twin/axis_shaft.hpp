// AxisShaft is the part of an Axis that knows the shaft of a specimen: where it is while it lags behind the pulses, has lost its step, or
// has drifted without current.
#pragma once

#include "adapters/uim342/twin/axis.hpp"

namespace axisgate::uim342::twin {

class AxisShaft {
public:
    explicit AxisShaft(Axis& axis) noexcept : a_(axis) {}

    /// The shaft is neither held nor coasting, and differs from the pulses.
    [[nodiscard]] static bool lags(const Axis& axis) noexcept { return axis.real_.differs() && !axis.held_ && !axis.coasting_; }
    /// Where it is, in the counter's numbering.
    [[nodiscard]] static double seat(const Axis& axis, Instant now) noexcept;
    /// The counter before it wraps.
    [[nodiscard]] static double counter(const Axis& axis, Instant now) noexcept {
        return axis.mechanics_.closed_loop && lags(axis) ? axis.real_.shown() : seat(axis, now);
    }
    /// It rests at the end of the profile.
    void fit(Instant now) noexcept;
    void follow_pulses(Instant now) noexcept;
    void stand_until(Instant now) noexcept;
    void slip_poles(Instant now) noexcept;
    /// The driver catches a shaft that has drifted: in closed loop its place becomes the demand, in open loop nobody has counted it.
    void drift_ends(Instant now) noexcept;

private:
    Axis& a_;
};

}  // namespace axisgate::uim342::twin
