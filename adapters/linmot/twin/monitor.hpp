// Monitor supervises supplies, temperatures and sensors of a simulated drive, with thermal models of its resistor and its motor. A warning
// comes before its error. It raises errors at their instants and never clears them.
#pragma once

#include "adapters/linmot/twin/memory.hpp"
#include "adapters/linmot/twin/order.hpp"
#include "adapters/linmot/twin/setup.hpp"
#include "adapters/linmot/twin/thermal.hpp"

namespace axisgate::linmot::twin {

class Monitor {
public:
    Monitor(Memory& memory, const Outside& outside, Series series) : memory_(memory), outside_(outside), series_(series) {}

    void power_on(Instant now);
    /// Updates the two thermal models to `now`.
    void warm(Instant now);
    /// The sensors report these conditions from now on.
    void seen(const Outside& next, Instant now) noexcept;
    /// Writes the temperatures of the sensors into the parameters.
    void show_temperatures();

    /// The next instant at which an error or a temperature calculation is due.
    [[nodiscard]] Instant due(Instant now) const;
    /// Whether the result can change with time alone.
    [[nodiscard]] bool watches() const noexcept;
    /// The first error that has a cause, after `warm`.
    [[nodiscard]] Fault fault(Instant now) const;
    /// The monitor's bits of the warn word.
    [[nodiscard]] std::uint16_t warnings(Instant now) const;
    /// Why the configuration is not valid: the voltages of the regeneration.
    [[nodiscard]] Fault misconfigured() const;
    /// The input for the safe voltage enable has been low long enough to remove the power [L4398-4401].
    [[nodiscard]] bool unsafe(Instant now) const noexcept;
    /// Whether the cause of an error persists, so that it cannot be acknowledged.
    [[nodiscard]] bool persists(Fault fault) const noexcept;
    [[nodiscard]] std::uint32_t hottest() const noexcept;

private:
    [[nodiscard]] bool warms() const noexcept;

    Memory& memory_;
    const Outside& outside_;
    Series series_;
    Instant ptc1_since_ = never, ptc2_since_ = never, motor_hot_since_ = never, sve_low_since_ = never;
    HeatChain<2> resistor_;
    HeatChain<3> motor_;
    Instant warmed_{};
    bool regenerates_ = false;
};

}  // namespace axisgate::linmot::twin
