// Motion in closed form: a profile is a short list of pieces of constant acceleration, asked for position and speed at an instant.
// In: where the axis is, how fast, where it shall go, its ramps. Out: profiles.
// Never ticks: a profile that nobody asks costs nothing. No jerk limit and no S-curve, because the manual documents none.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "gateway/core/instant.hpp"

namespace axisgate::uim342::twin {

/// An acceleration without a ramp: the speed steps (time ramps whose end is not above the cut-in speed, SD = 0).
inline constexpr double no_ramp = std::numeric_limits<double>::infinity();

struct Ramps {
    double acceleration = no_ramp;  ///< pulse/s^2
    double deceleration = no_ramp;  ///< pulse/s^2
    double cut_in = 0;              ///< pulse/s: speed steps to this at a start and from this to 0 at an end [L803-805]
    double backlash = 0;            ///< pulses that the motor makes uncounted after a reversal [L825]
    int last_direction = 0;         ///< -1, +1; 0: never moved, so there is nothing to take up
};

struct MotionState {
    double position = 0;  ///< pulse
    double velocity = 0;  ///< pulse/s
};

/// One piece: s(t) = position + velocity*t + acceleration*t^2/2 for `duration` seconds; uncounted pieces turn the motor alone.
struct Segment {
    double begin = 0;  ///< s after the start of the profile
    double duration = 0;
    double position = 0;
    double velocity = 0;
    double acceleration = 0;
    bool counted = true;

    [[nodiscard]] double position_at(double t) const noexcept {
        return counted ? position + velocity * t + acceleration * t * t / 2 : position;
    }
    [[nodiscard]] double velocity_at(double t) const noexcept { return velocity + acceleration * t; }
};

class Profile {
public:
    /// At rest at `position`.
    static Profile rest(double position) noexcept;
    /// Towards a speed, for ever; a reversal brakes with the deceleration to the cut-in speed, then 0, then starts anew. Target 0 stops.
    static Profile jog(Instant now, MotionState from, double velocity, const Ramps& ramps) noexcept;
    /// To a position with at most `speed`; brakes, and comes back, if it cannot stop in time. Ends exactly at `target`.
    /// Speed 0 stops instead.
    static Profile move(Instant now, MotionState from, double target, double speed, const Ramps& ramps) noexcept;
    /// To a stop with this rate. Ends at the nearest whole pulse.
    static Profile stop(Instant now, MotionState from, double rate, double cut_in) noexcept;

    [[nodiscard]] MotionState at(Instant now) const noexcept;
    /// When it is over; `never` for a jog.
    [[nodiscard]] Instant end() const noexcept { return end_; }
    /// A whole pulse; valid if it ends.
    [[nodiscard]] double end_position() const noexcept { return end_position_; }
    /// Whether the end is a commanded target.
    [[nodiscard]] bool reaches_target() const noexcept { return reaches_target_; }
    /// Direction of its last movement; 0 if it does not move.
    [[nodiscard]] int last_direction() const noexcept;
    /// Renumbers the positions: everything becomes less by `pulses`.
    void shift(double pulses) noexcept;
    /// First instant, not before `from`, at which the position is `distance` or more away from `centre`; `never` if it does not come.
    [[nodiscard]] Instant first_departure(Instant from, double centre, double distance) const noexcept;
    /// First instant, not before `from`, at which it is faster than `limit` in either direction; `never` if it never is.
    [[nodiscard]] Instant first_faster(Instant from, double limit) const noexcept;

    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    [[nodiscard]] const Segment& operator[](std::size_t i) const noexcept { return segments_[i]; }

private:
    // Longest: brake, uncounted and counted part of the acceleration (or of the cruise), cruise, brake.
    static constexpr std::size_t capacity = 8;

    void add(double duration, double velocity, double acceleration) noexcept;
    void brake(double to_speed, double rate, double cut_in) noexcept;
    void leave_rest(int direction, double speed, double distance, const Ramps& ramps) noexcept;
    void go_on(int direction, double speed, double distance, const Ramps& ramps) noexcept;
    void take_up_backlash(std::size_t first, double pulses) noexcept;
    void finish() noexcept;

    Instant start_{};
    Instant end_ = Instant::min();
    MotionState last_;   // while planning: state at the end of the pieces so far
    double length_ = 0;  // s
    double end_position_ = 0;
    bool reaches_target_ = false;
    std::size_t count_ = 0;
    std::array<Segment, capacity> segments_{};
};

}  // namespace axisgate::uim342::twin
