// Demand: where an axis should be at an instant, computed from the orders that its drive has acknowledged, for drives that do not say it.
// In: orders (target, speed, ramps) and the instants of their acknowledgement. Out: position and speed at any later instant.
// Never measured: who shows it says "computed". No jerk, no load, no clock of its own; unknown until told where the axis rests.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "gateway/core/instant.hpp"

namespace axisgate {

/// How a drive changes its speed. A rate of `infinity`: at once.
struct DemandRamps {
    static constexpr double at_once = std::numeric_limits<double>::infinity();
    double acceleration = at_once;  ///< increments/s^2, above 0
    double deceleration = at_once;  ///< increments/s^2, above 0
    double start_speed = 0;         ///< increments/s, 0 or more: the speed steps to it from rest, and from it to rest
};

struct DemandState {
    double position = 0;  ///< increments
    double velocity = 0;  ///< increments/s
};

/// A trapezoid, or what is left of one, in closed form: asking costs nothing between the questions, and any instant can be asked.
/// A new order goes on from the state that the old one had at that instant; a reversal brakes to rest first.
class Demand {
public:
    /// Nobody knows any more where the axis should be: off, moved by somebody else, ended by itself.
    void forget() noexcept { known_ = false; }
    [[nodiscard]] bool known() const noexcept { return known_; }

    /// Held there.
    void rest(double position) noexcept;
    /// To `target` at no more than `speed` (above 0). Ends exactly there; brakes and comes back if it cannot stop in time.
    void move(Instant now, double target, double speed, const DemandRamps& ramps) noexcept;
    /// At `velocity` for ever, its sign the direction; 0 brakes.
    void run(Instant now, double velocity, const DemandRamps& ramps) noexcept;
    /// Brakes to rest, whatever it was doing.
    void stop(Instant now, const DemandRamps& ramps) noexcept { run(now, 0, ramps); }

    /// Meaningless while not known. An instant before the last order is answered with that order's beginning.
    [[nodiscard]] DemandState at(Instant now) const noexcept;
    /// Whether the order is carried out at `now`: the demand rests.
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
    DemandState end_;    ///< while an order is taken: the state behind the pieces so far
    std::size_t count_ = 0;
    std::array<Piece, 4> pieces_{};  ///< brake to turn, rise or fall to the speed, cruise, brake to the end
};

}  // namespace axisgate
