// The VA interpolator: a trapezoid with separate acceleration and deceleration, in closed form.
// In: where it stands and how fast, a target, limits. Out: position and velocity at any later instant, its end, when it crosses a position.
// Never has a jerk limit [L3896-3913]; never measures: it is the demand.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "gateway/core/instant.hpp"

namespace axisgate::linmot::twin {

/// In 0.1 um, s. All above 0: a limit of 0 counts as 1 count (choice O-10).
struct Ramps {
    double velocity = 1;
    double acceleration = 1;
    double deceleration = 1;
};
struct Point {
    double position = 0;
    double velocity = 0;
};

class Profile {
public:
    /// Stands there; that is the target.
    void rest(double position, Instant now) noexcept;
    /// From `from` to `target`: against the target, or too fast to stop in time, it brakes to rest and starts anew; above the greatest
    /// velocity it brakes to it first (choice O-10).
    void move(Instant now, Point from, double target, const Ramps& ramps) noexcept;
    /// Endless motion; `direction` 1 or -1.
    void run(Instant now, Point from, double direction, const Ramps& ramps) noexcept;
    /// Brakes to rest; where it stands then is the target.
    void stop(Instant now, Point from, double deceleration) noexcept;

    [[nodiscard]] Point at(Instant now) const noexcept;
    [[nodiscard]] double target() const noexcept { return target_; }
    [[nodiscard]] const Ramps& ramps() const noexcept { return ramps_; }
    /// When it stands; `never`: endless.
    [[nodiscard]] Instant end() const noexcept { return end_; }
    [[nodiscard]] bool over(Instant now) const noexcept { return now >= end_; }
    [[nodiscard]] bool endless() const noexcept { return end_ == never; }
    /// The first instant after `after` at which it passes `position` in that direction; nothing: it never does.
    [[nodiscard]] std::optional<Instant> crossing(double position, bool upwards, Instant after) const noexcept;

private:
    struct Piece {
        double begin = 0, length = 0, position = 0, velocity = 0, acceleration = 0;
    };
    void clear(Instant now, Point from, const Ramps& ramps) noexcept;
    void add(double length, double acceleration) noexcept;
    void to_velocity(double velocity, double rate) noexcept;
    void approach(double target) noexcept;
    void close() noexcept;
    [[nodiscard]] Instant instant(double seconds) const noexcept;

    Instant since_{}, end_{};
    Ramps ramps_;
    double target_ = 0;
    Point now_;  ///< while it is made: the state behind the pieces so far
    double length_ = 0;
    std::array<Piece, 6> pieces_{};
    std::size_t count_ = 0;
};

}  // namespace axisgate::linmot::twin
