// Mechanics calculates the demand position of the simulated servo at any instant, as segments of a profile, and the position of a shaft
// that lags behind it, is blocked, or follows it with finite force, friction and play. Each order (to a position, at a speed, with a
// torque, to a stop) continues from the state that the previous one has reached, without a jump. Units: increments of the motor, seconds.
#pragma once

#include <vector>

#include "adapters/cia402/twin/profile.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/core/shaft.hpp"

namespace axisgate::cia402_drive::twin {

class Mechanics {
public:
    void move(double target, const Ramps& ramps, Instant now);
    void run(double velocity, const Ramps& ramps, Instant now);
    void stop(const Ramps& ramps, Instant now) { run(0, ramps, now); }
    /// One step of a cyclic mode: reaches the target in `seconds` and then waits for the next step.
    void step_to(double target, double seconds, Instant now);
    /// A torque on a shaft without friction, up to a speed. `slope` is the rate of change of the acceleration, increments/s^3; 0: at once.
    void push(double acceleration, double slope, double most_velocity, Instant now);
    /// The demand position is set here, at standstill: power was removed, or the shaft has slipped.
    void rest_at(double position, Instant now);
    void hold(bool held, Instant now);
    /// Lag of a position controller: the shaft follows its demand with this delay.
    void set_lag(double seconds) { lag_ = seconds; }
    [[nodiscard]] bool lags() const noexcept { return lag_ > 0; }
    /// How the shaft differs from its demand, from now on; it begins at its present position. Replaces `set_lag`.
    void set_shaft(const ShaftFreedoms& freedoms, std::uint64_t seed, Instant now);
    [[nodiscard]] bool differs() const noexcept { return motor_.differs(); }
    /// Without power a shaft that differs from its demand runs out with it, and then drifts.
    void set_power(bool on, Instant now);

    /// Errors of the encoder from now on: `misread` is a constant offset, `swing` an oscillation by `size` increments to both sides with a
    /// period of 7 ms.
    void misread(double by) { misread_ = by; }
    void swing(double size) { swing_ = size; }
    [[nodiscard]] double swings() const noexcept { return swing_; }
    [[nodiscard]] bool misreads() const noexcept { return misread_ != 0 || swing_ != 0; }

    [[nodiscard]] Motion demand(Instant now) const;
    /// Where `differs`: not for an instant in the future, because the shaft has no closed form.
    [[nodiscard]] Motion shaft(Instant now) const;
    /// As the encoder reports it.
    [[nodiscard]] double read(Instant now) const;
    [[nodiscard]] bool held() const noexcept { return held_; }
    /// When the demand reaches standstill or its final speed.
    [[nodiscard]] Instant end() const;
    [[nodiscard]] bool moves(Instant now) const;
    /// The present torque as an acceleration, also when the top speed is reached.
    [[nodiscard]] double pushed(Instant now) const;

private:
    struct Piece {
        double begin;  // seconds after since_
        Motion from;
        Segment how;
    };
    void begin(Instant now);
    void take(const Profile& profile);
    void add(const Segment& segment);
    void rest() { pieces_.push_back({end_, at_, {}}); }
    void follow(Instant now) const;
    std::vector<Piece> pieces_{{0, {}, {}}};
    Instant since_{};
    Motion at_;
    double end_ = 0, held_at_ = 0, step_velocity_ = 0, lag_ = 0, misread_ = 0, swing_ = 0;
    double push_from_ = 0, push_to_ = 0, push_slope_ = 0;
    bool held_ = false, on_ = true;
    mutable Shaft motor_;           ///< advanced when it is asked for, with the demand until then
    mutable bool ran_out_ = false;  ///< without power, it has reached standstill
};

}  // namespace axisgate::cia402_drive::twin
