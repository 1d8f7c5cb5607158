// Computes the demand position of an axis at any instant from the orders that its drive has acknowledged (target, speed, ramps), for drives
// that do not report it. It knows no jerk and no load, and it is unknown until the rest position is given. A value from here must be shown
// as "computed".
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "gateway/core/instant.hpp"

namespace axisgate {

/// The ramps with which a drive changes its speed. A rate of `infinity` means at once.
struct DemandRamps {
    static constexpr double at_once = std::numeric_limits<double>::infinity();
    double acceleration = at_once;  ///< increments/s^2, above 0
    double deceleration = at_once;  ///< increments/s^2, above 0
    double start_speed = 0;         ///< increments/s, 0 or more: the speed steps to this value from rest, and from it to rest
};

struct DemandState {
    double position = 0;  ///< increments
    double velocity = 0;  ///< increments/s
};

/// A trapezoid, or the rest of one, in closed form, so that it can be evaluated at any instant. A new order continues from the state at
/// that instant; a reversal brakes to rest first.
class Demand {
public:
    /// The demand becomes unknown: the axis is off, was moved by another client, or ended its motion by itself.
    void forget() noexcept { known_ = false; }
    [[nodiscard]] bool known() const noexcept { return known_; }

    /// The axis is held at this position.
    void rest(double position) noexcept;
    /// Moves to `target` with at most `speed` (above 0) and ends exactly there; if it cannot stop in time, it brakes and returns.
    void move(Instant now, double target, double speed, const DemandRamps& ramps) noexcept;
    /// Moves with `velocity` without an end; its sign is the direction, and 0 brakes.
    void run(Instant now, double velocity, const DemandRamps& ramps) noexcept;
    /// Brakes to rest from any motion.
    void stop(Instant now, const DemandRamps& ramps) noexcept { run(now, 0, ramps); }

    /// Without meaning while the demand is unknown. An instant before the last order is answered with the begin of that order.
    [[nodiscard]] DemandState at(Instant now) const noexcept;
    /// True if the order is finished at `now`, that is, the demand rests.
    [[nodiscard]] bool over(Instant now) const noexcept;

private:
    struct Piece {
        double begin = 0;  ///< s after the order
        double position = 0;
        double velocity = 0;
        double acceleration = 0;
    };
    void begin(Instant now) noexcept;
    void add(double seconds, double velocity, double acceleration) noexcept;
    void brake(double to_speed, const DemandRamps& ramps) noexcept;
    void accelerate(double direction, double to_speed, const DemandRamps& ramps) noexcept;

    bool known_ = false;
    Instant since_{};
    double length_ = 0;  ///< s; infinite for a run
    DemandState end_;    ///< while an order is accepted: the state behind the pieces so far
    std::size_t count_ = 0;
    std::array<Piece, 4> pieces_{};  ///< brake to reverse, change to the speed, cruise, brake to the end
};

}  // namespace axisgate
