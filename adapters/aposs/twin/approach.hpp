// Approach of SYNCMSTART 7: a polynomial of fifth order that brings the slave to its marker when the master is at one [L4425-4446]. It uses
// known markers and both velocities, one step per ms, and never exceeds the given VEL, ACC and jerk. If it is not possible, SYNCMSTART 5 is
// used. Units: qc, ms.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace axisgate::aposs {

/// The way to the nearest of equal places with the distance `cycle`; 0: there is only one place.
[[nodiscard]] inline double nearest(double way, double cycle) { return cycle > 0 ? way - cycle * std::round(way / cycle) : way; }
/// The remainder of a way after complete cycles, with its sign.
[[nodiscard]] inline double within_cycle(double way, double cycle) { return cycle > 0 ? std::fmod(way, cycle) : way; }

struct ApproachMaster {
    double gear = 1;        ///< SYNCFACTS / SYNCFACTM
    double pulse = 500;     ///< SYNCMPULSM, qc of the master
    double cycle = 500;     ///< distance of equivalent places of the slave: SYNCMPULSS times SYNCMARKS
    double filter_ms = 50;  ///< of the master's velocity: SYNCVFTIME, at least 50 ms
};
struct ApproachLimits {
    double velocity = 0, acceleration = 0;  ///< VEL, ACC
    double jerk = 0;                        ///< 0: not set
};
struct ApproachInput {
    double master = 0, way = 0;                         ///< position, and its change in this ms
    std::optional<double> master_marker, slave_marker;  ///< the last known markers; the slave's includes SYNCPOSOFFS
    double command = 0, velocity = 0;                   ///< of the slave at the end of the previous ms
};

class Approach {
public:
    void begin() {
        *this = {};
        phase_ = Phase::waits;
    }
    void shift_master(double by) { begun_at_ -= by; }
    [[nodiscard]] bool active() const noexcept { return phase_ == Phase::waits || phase_ == Phase::runs; }
    [[nodiscard]] bool arrived() const noexcept { return phase_ == Phase::arrived; }
    /// One millisecond. If it is then neither active nor arrived, SYNCMSTART 5 applies.
    double step(const ApproachMaster& to, const ApproachLimits& limits, const ApproachInput& in);

private:
    enum class Phase : std::uint8_t { none, waits, runs, arrived, given_up };
    void start(const ApproachMaster& to, const ApproachLimits& limits, const ApproachInput& in);
    [[nodiscard]] double along(double share) const;

    Phase phase_ = Phase::none;
    double speed_ = 0, waited_ = 0;  ///< of the master, filtered; ms
    bool seen_ = false;
    // the curve as a function of the master's way, so that the marker is met even if the master's speed changes slightly
    double begun_speed_ = 0, begun_at_ = 0, master_way_ = 0, from_ = 0, time_ = 0, from_velocity_ = 0, gain_ = 0, rest_ = 0;
};

}  // namespace axisgate::aposs
