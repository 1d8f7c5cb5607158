// Profile: motion in closed form: a short list of pieces, each one ramp or one constant speed, asked for position and speed at an instant.
// In: where the axis is and how fast, where it shall go, VI, VM and the two ramps. Out: profiles, their ends and crossings of positions.
// Never ticks: a profile that nobody asks costs nothing. Positions are in the drive's present unit: microsteps or encoder counts.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "gateway/core/instant.hpp"

namespace axisgate::mcode::twin {

/// The ramp of AT or DT = 2 (linear rise and fall of the acceleration) or 3 (raised cosine), cut into the 256 points of the drive's table.
/// AJ or DJ points on each side of the centre hold the full acceleration: the flat part is 2*AJ/256 [L1381, L2432, E-23].
/// Within a point the acceleration is constant, so speed is continuous and both ends are exact.
class RampTable {
public:
    static constexpr int points = 256;
    RampTable(int type, int half_flat) noexcept;
    /// Part of the change of speed that is done at part `u` (0..1) of the time.
    [[nodiscard]] double speed(double u) const noexcept;
    /// Part of (change of speed * time) that is travelled at `u`; 0.5 at the end, as with a linear ramp.
    [[nodiscard]] double travel(double u) const noexcept;

private:
    std::array<double, points + 1> speed_{};
    std::array<double, points + 1> travel_{};
};

/// How speed changes: AT, AJ, A or DT, DJ, D.
struct Ramp {
    int type = 1;       ///< 1 linear, 2 triangle S, 3 sinusoidal S
    int half_flat = 0;  ///< 0..127 points; types 2 and 3
    double rate = 1;    ///< units/s^2: the acceleration, of an S its peak [L1381]

    /// Constant acceleration that takes as long: an S ramp takes 2*dv/(A*(1+f)) with its flat part f.
    [[nodiscard]] double mean() const noexcept { return type == 1 ? rate : rate * (1 + 2.0 * half_flat / RampTable::points) / 2; }
};

struct Kinematics {
    double vi = 1;  ///< units/s: speed jumps to this at a start and from this to 0 at an end
    double vm = 1;  ///< units/s
    Ramp up;
    Ramp down;
};

/// The whole unit that a counter shows: halves upwards on both sides of 0, so that renumbering by whole units changes nothing else.
[[nodiscard]] inline double nearest(double v) noexcept { return std::floor(v + 0.5); }

struct Travel {
    double position = 0;  ///< units
    double velocity = 0;  ///< units/s, signed
};

class Profile {
public:
    /// At rest.
    static Profile rest(double position) noexcept;
    /// To a position; `go_on`: past it without a stop. From a motion: brakes and comes back if it cannot stop in time. Ends exactly at
    /// `target`, a whole unit.
    static Profile move(Instant now, Travel from, double target, const Kinematics& k, bool go_on);
    /// Towards a speed, for ever; through 0 if the sign changes. Speed 0 stops, at the nearest whole unit.
    static Profile slew(Instant now, Travel from, double velocity, const Kinematics& k);
    /// At one speed to a position, without ramps.
    static Profile creep(Instant now, double from, double target, double speed) noexcept;

    [[nodiscard]] Travel at(Instant now) const noexcept;
    [[nodiscard]] Instant end() const noexcept { return end_; }
    [[nodiscard]] double end_position() const noexcept { return end_position_; }
    /// Whether speed is being changed: +1 up, -1 down, 0 constant.
    [[nodiscard]] int changing(Instant now) const noexcept;
    /// First instant after `from` at which position `x`, which lies ahead of the place at `from`, is reached or passed; `direction` other
    /// than 0: only while moving that way. `never` if it does not come.
    [[nodiscard]] Instant crossing(Instant from, double x, int direction = 0) const noexcept;
    /// Renumbers the positions.
    void shift(double by) noexcept;

private:
    struct Piece {
        double begin = 0;     ///< s after start_
        double duration = 0;  ///< s; infinite for the last of a slew
        double position = 0;
        double velocity = 0;
        double change = 0;  ///< of the velocity, signed
        const RampTable* table = nullptr;
    };
    // Longest: brake, reverse: ramp up, cruise, ramp down; and one to spare.
    static constexpr std::size_t capacity = 6;

    [[nodiscard]] static Travel in_piece(const Piece& p, double t) noexcept;
    [[nodiscard]] const Piece* piece_at(double t) const noexcept;
    [[nodiscard]] double time_of(Instant now) const noexcept { return seconds(now - start_); }
    void begin(Instant now, Travel from, const Kinematics& k);
    void ramp_to(double speed, bool up, const Kinematics& k) noexcept;
    void cruise(double duration) noexcept;
    void brake(const Kinematics& k) noexcept;
    void finish(double end_position) noexcept;

    Instant start_{};
    Instant end_ = Instant::min();
    double end_position_ = 0;
    double length_ = 0;  // s, while planning
    Travel last_;        // while planning
    std::shared_ptr<const RampTable> up_;
    std::shared_ptr<const RampTable> down_;
    std::size_t count_ = 0;
    std::array<Piece, capacity> pieces_{};
};

}  // namespace axisgate::mcode::twin
