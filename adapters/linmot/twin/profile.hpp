// Profile is the trapezoidal profile of the VA interpolator with separate acceleration and deceleration, in closed form: position and
// velocity at any later instant, its end, and the crossing of a position. There is no jerk limit [L3896-3913].
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "gateway/core/instant.hpp"

namespace axisgate::linmot::twin {

/// In 0.1 um, s. All are above 0: a limit of 0 counts as 1 count (choice O-10).
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
    /// Standstill at this position, which is also the target.
    void rest(double position, Instant now) noexcept;
    /// From `from` to `target`: if the motion leads away from the target, or cannot stop in time, it decelerates to standstill and starts
    /// again; above the maximum velocity it decelerates to that first (choice O-10).
    void move(Instant now, Point from, double target, const Ramps& ramps) noexcept;
    /// Endless motion; `direction` 1 or -1.
    void run(Instant now, Point from, double direction, const Ramps& ramps) noexcept;
    /// Decelerates to standstill; the final position is the target.
    void stop(Instant now, Point from, double deceleration) noexcept;

    [[nodiscard]] Point at(Instant now) const noexcept;
    [[nodiscard]] double target() const noexcept { return target_; }
    [[nodiscard]] const Ramps& ramps() const noexcept { return ramps_; }
    /// When standstill is reached; `never`: endless.
    [[nodiscard]] Instant end() const noexcept { return end_; }
    [[nodiscard]] bool over(Instant now) const noexcept { return now >= end_; }
    [[nodiscard]] bool endless() const noexcept { return end_ == never; }
    /// The first instant after `after` at which the motion passes `position` in that direction; empty: it never does.
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
    Point now_;  ///< during construction: the state after the present segments
    double length_ = 0;
    std::array<Piece, 6> pieces_{};
    std::size_t count_ = 0;
};

}  // namespace axisgate::linmot::twin
