// Lead: one target per cycle for a drive that follows cyclic set-points and plans no way of its own: towards the newest set-point, never
// faster than its speed and never a step that its ramps do not allow.
// In: where the axis is when the stream begins, the newest set-point, the cycle. Out: the next target. Never looks back or ahead further
// than one cycle, and holds no queue.
#pragma once

namespace axisgate::drive {

/// Increments/s and increments/s^2, all above 0.
struct LeadRamps {
    double velocity = 0, acceleration = 0, deceleration = 0;
};

class Lead {
public:
    /// From standstill at this place (increments).
    void begin(double place) noexcept { place_ = place, velocity_ = 0; }
    /// The next place on the way to `target`; it stops there without passing it by more than a cycle's rounding.
    double towards(double target, const LeadRamps& ramps, double cycle_s) noexcept;
    /// The next speed on the way to this one.
    double speed_towards(double velocity, const LeadRamps& ramps, double cycle_s) noexcept;
    [[nodiscard]] double place() const noexcept { return place_; }
    [[nodiscard]] double velocity() const noexcept { return velocity_; }
    void stand() noexcept { velocity_ = 0; }

private:
    double place_ = 0, velocity_ = 0;
};

}  // namespace axisgate::drive
