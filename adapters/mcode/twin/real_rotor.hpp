// RealRotor: where the rotor really is while the closed form says where it should be: behind its field as it is accelerated, ringing,
// stuck by friction, behind a play, without power somewhere else. A stepper has no loop that lags with speed, so the speed is fed forward.
// In: the place of the closed form at any instant. Out: what the encoder shows; whether the motor lost its step.
// Never ends a motion: Course does.
#pragma once

#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/manners.hpp"

namespace axisgate::mcode::twin {

class RealRotor {
public:
    /// The increments of the freedoms, on one turn: microsteps of the factory setting, whatever MS and EE are.
    static constexpr double per_turn = 51200;
    /// Two full steps behind its field a rotor of 200 steps falls out of it.
    static constexpr double pull_out = per_turn / 200 * 2;

    explicit RealRotor(const MotorManners& manners);

    struct Place {
        double turns = 0, turns_per_second = 0;
    };
    [[nodiscard]] bool differs() const noexcept { return real_.differs(); }
    /// The whole millisecond of the last call.
    [[nodiscard]] Instant at() const noexcept { return real_.point().at; }
    /// It stands here, in turns, and so does its field.
    void set(double turns, Instant now);
    /// Follows until then; `field` gives the Place of the closed form at an instant. It ends at the first millisecond at which the motor
    /// falls out of step (unless `caught`: it has) or `ends` is true of what the encoder shows, in turns; that instant, or `never`.
    template <class Field, class Ends>
    Instant follow(Instant until, bool caught, Field&& field, Ends&& ends);
    /// Without current.
    void drift(Instant until);
    /// What the encoder shows, in turns, as of the last call.
    [[nodiscard]] double shown() const noexcept { return real_.shown() / per_turn; }
    /// The last `follow` ended because the force of the motor has not sufficed: the rotor is so far behind one with enough force that it
    /// falls out of its field.
    [[nodiscard]] bool out_of_step() const noexcept { return out_of_step_; }

private:
    double lead_s_ = 0;  ///< of the speed that is fed forward
    bool limited_ = false;
    bool out_of_step_ = false;
    axisgate::Shaft real_, strong_;  ///< with the force of the motor, and with any force; `strong_` is at a stride before `real_`
};

template <class Field, class Ends>
Instant RealRotor::follow(Instant until, bool caught, Field&& field, Ends&& ends) {
    const auto demand = [&](Instant at) {
        const Place p = field(at);
        return (p.turns + lead_s_ * p.turns_per_second) * per_turn;
    };
    out_of_step_ = false;
    const auto fails = [&](const ShaftPoint& p) {
        if (limited_ && !caught && p.force >= 1) {
            axisgate::Shaft strong = strong_;
            strong.advance(p.at, demand);
            out_of_step_ = std::abs(strong.position() - p.position) > pull_out;
        }
        return out_of_step_ || ends(p.at, p.load / per_turn);
    };
    const Instant ended = real_.advance_until(until, demand, fails);
    constexpr Duration stride = axisgate::Shaft::stride;
    if (limited_) strong_.advance(std::min(until, ended) - (std::min(until, ended) - time_zero) % stride, demand);
    return ended;
}

}  // namespace axisgate::mcode::twin
