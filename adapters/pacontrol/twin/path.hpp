// One straight motion in closed form: a trapezoid from the start-stop speed to the speed and back (E-33).
// In: start, target, speeds, acceleration. Out: position and speed at any instant, and the instant at which a place is reached.
// Never steps through time.
#pragma once

#include "gateway/core/instant.hpp"

namespace axisgate::pacontrol::twin {

/// Longest motion the model counts, seconds: keeps instants in range, whatever the parameters say.
inline constexpr double longest_motion_s = 1e8;

class Path {
public:
    /// No motion: stands at 0.
    Path() = default;
    /// From `x0` to `x1`, axis units, with `entry` speed (>= 0, in that direction). `speed` is reached with `acceleration`; motion
    /// begins and ends at `start_stop` at least, for a stepper needs no ramp below it.
    [[nodiscard]] static Path to(double x0, double x1, double entry, double speed, double start_stop, double acceleration, Instant t0);
    /// Slows down from `entry` and stands as soon as the ramp allows. `direction`: 1 or -1.
    [[nodiscard]] static Path halt(double x0, double direction, double entry, double start_stop, double acceleration, Instant t0);

    [[nodiscard]] Instant end() const noexcept { return end_; }
    [[nodiscard]] double direction() const noexcept { return direction_; }
    [[nodiscard]] double last() const noexcept { return x1_; }
    [[nodiscard]] double peak() const noexcept { return peak_; }  ///< the highest speed on the way, AE/s
    [[nodiscard]] double position(Instant t) const noexcept;
    /// Signed, axis units/s.
    [[nodiscard]] double velocity(Instant t) const noexcept;
    /// When `x` is passed; `never` if it is not on the way.
    [[nodiscard]] Instant when(double x) const noexcept;

private:
    void finish(Instant t0) noexcept;
    double x0_ = 0, x1_ = 0, direction_ = 1;
    double entry_ = 0, peak_ = 0, exit_ = 0, a_ = 1;
    double t1_ = 0, t2_ = 0, t3_ = 0, d1_ = 0, d2_ = 0;
    Instant t0_{}, end_{};
};

}  // namespace axisgate::pacontrol::twin
