// Lead calculates one target per cycle for a drive that follows cyclic set-points and has no profile generator of its own. Each target lies
// on the way to the newest set-point, within the speed and the ramps of the axis. There is no queue: only the newest set-point counts.
#pragma once

namespace axisgate::drive {

/// Increments/s and increments/s^2; all are greater than 0.
struct LeadRamps {
    double velocity = 0, acceleration = 0, deceleration = 0;
};

class Lead {
public:
    /// Starts from standstill at this position (increments).
    void begin(double place) noexcept { place_ = place, velocity_ = 0; }
    /// The next position on the way to `target`. It overshoots the target by no more than the rounding of one cycle.
    double towards(double target, const LeadRamps& ramps, double cycle_s) noexcept;
    /// The next speed on the way to `velocity`.
    double speed_towards(double velocity, const LeadRamps& ramps, double cycle_s) noexcept;
    [[nodiscard]] double place() const noexcept { return place_; }
    [[nodiscard]] double velocity() const noexcept { return velocity_; }
    void stand() noexcept { velocity_ = 0; }

private:
    double place_ = 0, velocity_ = 0;
};

}  // namespace axisgate::drive
