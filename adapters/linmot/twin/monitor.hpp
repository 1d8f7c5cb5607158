// What a simulated drive watches: supplies, temperatures and their models, sensors. Warnings come before their errors.
// In: what is outside, time. Out: warnings, the error that is due, when one becomes due. Never clears an error.
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
    /// The two models up to now.
    void warm(Instant now);
    /// What the sensors say from now on, before it is so.
    void seen(const Outside& next, Instant now) noexcept;
    /// The temperatures of the sensors, where they are read.
    void show_temperatures();

    /// The next instant at which an error or a look at the temperatures is due.
    [[nodiscard]] Instant due(Instant now) const;
    /// Whether something can have changed by time alone.
    [[nodiscard]] bool watches() const noexcept;
    /// The first error that there is cause for, after `warm`.
    [[nodiscard]] Fault fault(Instant now) const;
    /// Its bits of the warn word.
    [[nodiscard]] std::uint16_t warnings(Instant now) const;
    /// Why the configuration cannot work: the regeneration's voltages.
    [[nodiscard]] Fault misconfigured() const;
    /// The input for the safe voltage enable is low for so long that it takes the power [L4398-4401].
    [[nodiscard]] bool unsafe(Instant now) const noexcept;
    /// Whether the cause of an error is still there, so that it cannot be acknowledged.
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
