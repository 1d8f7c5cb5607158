// Power: what the bridges get their current from: supply, temperature, and what has switched them off beside DE.
// In: figures, faults, the enable input of an LMM. Out: whether the motor may run.
// Never ends a motion: who switches off does that.
#pragma once

#include "adapters/mcode/twin/settings.hpp"
#include "adapters/mcode/twin/thermal.hpp"

namespace axisgate::mcode::twin {

struct Power {
    explicit Power(const Settings& settings) : settings_(settings) { supply.has_aux = settings.is(lmd); }

    Supply supply;
    bool enable_input = true;
    bool off = false;  ///< by a fault: locked rotor, over-temperature, LMM's enable input

    /// DE, and no fault.
    [[nodiscard]] bool enabled() const noexcept { return settings_[Word::DE] != 0 && !off; }
    [[nodiscard]] bool good() const noexcept { return enabled() && supply.plus_v_good(); }

private:
    const Settings& settings_;
};

}  // namespace axisgate::mcode::twin
