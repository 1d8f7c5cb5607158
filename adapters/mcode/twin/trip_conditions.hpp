// TripConditions: the conditions of TI, TP, TR, TC, TA and TM, and what a trip leaves: PC and pulses of the trip output.
// In: their fields, TE, edges, places. Out: events of trips.
// Never knows a subroutine: that is the language's, and TT's time too.
#pragma once

#include <span>

#include "adapters/mcode/twin/io.hpp"
#include "adapters/mcode/twin/motor_events.hpp"
#include "adapters/mcode/twin/shaft.hpp"

namespace axisgate::mcode::twin {

class TripConditions {
public:
    TripConditions(const Shaft& shaft, const Inputs& inputs, const Outputs& outputs, MotorEvents& events)
        : shaft_(shaft), inputs_(inputs), outputs_(outputs), events_(events) {}

    /// TI input; TP position; TR distance[,repeat]; TA mask; TC and TM have no field. Code 12: TC without an input of type 12.
    [[nodiscard]] int arm(Word trip, std::span<const Number> fields, Instant now);
    void enable(int te, Instant now) noexcept;
    void restart() noexcept;

    void input(const InputEdge& e, Instant now);
    /// A bit of TA's mask has come true.
    void status(int bit, Instant now);
    void supply_low(Instant now);
    /// P goes to PC, and the trip output pulses.
    void capture(Instant now) noexcept;

    /// TP and TR, by the present motion.
    void plan(bool stepping, Instant now) noexcept;
    [[nodiscard]] Instant deadline() const noexcept;
    void pass(Instant t);
    void shift(double by) noexcept { distance_from_ += by; }

    [[nodiscard]] std::int64_t captured() const noexcept { return captured_; }
    [[nodiscard]] std::int64_t pulses() const noexcept { return pulses_; }

private:
    [[nodiscard]] bool enabled(Word trip) const noexcept { return (te_ >> trip_index(trip) & 1) != 0; }
    void fire(Word trip, Instant now);

    const Shaft& shaft_;
    const Inputs& inputs_;
    const Outputs& outputs_;
    MotorEvents& events_;
    int te_ = 0;
    int input_ = 0;
    double position_ = 0, distance_ = 0, distance_from_ = 0;
    int mask_ = 0;
    Instant pause_until_ = Instant::min();
    Instant position_due_ = never, distance_due_ = never, pause_due_ = never;
    std::int64_t captured_ = 0;  ///< PC
    std::int64_t pulses_ = 0;
};

}  // namespace axisgate::mcode::twin
