// Motion profiles from a state (position, speed, acceleration) to a speed or a position, as segments in closed form. The speed never jumps.
// Units: increments, seconds.
// Linear: constant acceleration. Sine (6086h = 1): the speed follows half a cosine in the time of the linear ramp. Jerk (6086h = 3):
// acceleration and deceleration are built up and reduced, each with its own jerk (60A4h:01 to 04).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace axisgate::cia402_drive::twin {

struct Motion {
    double position = 0, velocity = 0, acceleration = 0;
};

enum class Shape : std::uint8_t { linear, sine, jerk };
struct Ramps {
    double velocity = 0, up = 0, down = 0;  ///< increments/s, increments/s^2
    Shape shape = Shape::linear;
    std::array<double, 4> jerk{};  ///< increments/s^3: acceleration up, back, deceleration up, back; 0: that ramp is linear
};

struct Segment {
    double seconds = 0, acceleration = 0, jerk = 0;
    double swing = 0;  ///< change of speed along half a cosine in this segment
};
[[nodiscard]] Motion along(const Motion& from, const Segment& segment, double seconds);

struct Profile {
    std::vector<Segment> segments;  ///< at most 16
    Motion end;
};
[[nodiscard]] Profile profile_to_speed(const Motion& from, double velocity, const Ramps& ramps);
/// Ends exactly at the target, at standstill; if it cannot stop in time, it returns. A top speed of 0 gives no motion.
[[nodiscard]] Profile profile_to_place(const Motion& from, double target, const Ramps& ramps);

}  // namespace axisgate::cia402_drive::twin
