// Parts: what the motor is made of below its motions, each with the few others that it looks at.
// In: the kind of drive. Out: the parts, in factory state.
// Never decides anything.
#pragma once

#include "adapters/mcode/twin/hmt.hpp"
#include "adapters/mcode/twin/limits.hpp"
#include "adapters/mcode/twin/power.hpp"
#include "adapters/mcode/twin/real_rotor.hpp"

namespace axisgate::mcode::twin {

struct Parts {
    explicit Parts(const MechanismSetup& setup)
        : settings(setup),
          inputs(setup.frame_size == 17 ? 3 : input_count, settings.is(lmd)),
          outputs(setup.frame_size == 17, settings.is(lmdc)) {
        inputs.factory({});
        outputs.factory();
    }
    Parts(const Parts&) = delete;
    Parts& operator=(const Parts&) = delete;

    Settings settings;
    MotorEvents events;
    Inputs inputs;
    Outputs outputs;
    Power power{settings};
    Shaft shaft{settings};
    RealRotor real{settings.manners()};
    TripConditions trips{shaft, inputs, outputs, events};
    Limits limits{shaft, inputs};
    Cams cams{shaft, inputs, static_cast<double>(settings.manners().switch_hysteresis) / RealRotor::per_turn};
    ClosedLoop loop{settings, shaft, trips, events};
};

}  // namespace axisgate::mcode::twin
