// RealRotor: where the rotor really is while the closed form says where it should be: behind its field as it is accelerated, ringing,
// stuck by friction, behind a play, without power somewhere else. A stepper has no loop that lags with speed, so the speed is fed forward.
// In: the place of the closed form at each millisecond. Out: how far the encoder shows it from there; whether the motor lost its step.
// Never ends a motion: Course does.
#pragma once

#include "adapters/mcode/twin/manners.hpp"

namespace axisgate::mcode::twin {

class RealRotor {
public:
    /// The increments of the freedoms, on one turn: microsteps of the factory setting, whatever MS and EE are.
    static constexpr double per_turn = 51200;
    /// Two full steps behind its field a rotor of 200 steps falls out of it.
    static constexpr double pull_out = per_turn / 200 * 2;

    explicit RealRotor(const MotorManners& manners);

    [[nodiscard]] bool differs() const noexcept { return real_.differs(); }
    /// Until when it has been calculated: whole milliseconds.
    [[nodiscard]] Instant at() const noexcept { return at_; }
    /// It stands here, in turns, and so does its field.
    void set(double turns, Instant now);
    /// One millisecond on; place and speed of the closed form then, in turns and turns/s.
    void step(double turns, double turns_per_second);
    void step_without_power(double turns);
    /// What the encoder shows minus the place of the closed form, in turns.
    [[nodiscard]] double stray() const noexcept { return stray_; }
    /// The force of the motor has not sufficed: it is so far behind a rotor with enough force that it falls out of its field.
    [[nodiscard]] bool out_of_step() const noexcept;
    /// A time that nobody has asked about is passed over but for its last seconds.
    void skip_to(Instant now) noexcept;

private:
    double lead_s_ = 0;  ///< of the speed that is fed forward
    bool limited_ = false;
    axisgate::Shaft real_, strong_;  ///< with the force of the motor, and with any force
    Instant at_{};
    double stray_ = 0;
};

}  // namespace axisgate::mcode::twin
