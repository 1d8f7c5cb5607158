// What an axis is made as, and what is true of it while nothing moves: power, reference flag, faults, what is outside.
// In: values that its parts set. Out: the same. Never moves anything; the place of the shaft is shaft.hpp's.
#pragma once

#include <cstdint>

#include "gateway/core/instant.hpp"
#include "gateway/core/shaft.hpp"

namespace axisgate::pacontrol::twin {

struct AxisModel {
    bool ep = true;                   ///< PA-CONTROL EP: encoder, temperature, speed change while moving
    bool measuring = true;            ///< the option measuring mode exists, else 6Ch
    bool manual_at_traverse = false;  ///< speed of 0A90/0A91: traverse speed instead of manual speed (E-32)
    int switch_on_mode = 1;       ///< 0: an interrupted traverse is dropped at axis ON; 1..3: it goes on; 4: and displacement is watched
    double max_displacement = 1;  ///< AE, while the axis is off, for switch_on_mode 4
    double travel_min = -10'050, travel_max = 10'050;  ///< AE of the shaft: where the switches at the ends of travel are
    double revolution = 0;  ///< AE; above 0 a rotary axis: one switch just before each whole turn, seen in both directions [L834]
    Duration watchdog = std::chrono::seconds(1);  ///< of a manual move [L3553]

    // --- freedoms ---
    Duration motion_start{};         ///< a motion begins so much later than its command was acknowledged
    Duration axis_on{};              ///< from 0A97 until the axis is on
    Duration status_behind{};        ///< the axis status that is shown
    Duration position_every{};       ///< the position that is shown is refreshed at multiples of this; 0: always
    bool reference_shown = true;     ///< false: the axis status does not show a reference run as a motion
    bool measured_position = false;  ///< 190C shows the encoder's position, not the control's counter
    double hysteresis = 0;           ///< AE: a switch opens so far from where it closes
    ShaftFreedoms mechanics;         ///< in 0.001 AE
    std::uint64_t seed = 0;
};

/// Motor state as in the status word of the module interface [L734-L760].
enum class AxisPower : std::uint8_t { on, halt, idle, safe, disabled };

/// Outside conditions of an axis that nothing but itself depends on.
struct AxisOutside {
    bool power_pack = true;
    bool encoder_broken = false;
    double temperature = 35;  ///< degrees C
};

struct AxisState {
    AxisPower power = AxisPower::on;
    bool off = false;  ///< axis ON was taken away
    bool referenced = false;
    bool measuring = false;
    bool displaced = false;  ///< while it was off
    std::uint16_t fault = 0;
    std::uint16_t raised = 0;  ///< a system error that came up by itself and was not told yet
    bool changed = false;      ///< the rest position, the counter or the reference flag: something to keep
    double shift = 0;          ///< AE, G29
    double off_position = 0;   ///< AE, when it was switched off (SR51..) ...
    double off_place = 0;      ///< ... and of the shaft
    Instant on_at = never;     ///< 0A97 was acknowledged: when it will be on, if that takes time ...
    bool on_goes_on = false;   ///< ... and whether an interrupted traverse goes on then
    AxisOutside outside;

    [[nodiscard]] bool switching_on() const noexcept { return on_at != never; }
    /// The motor holds the shaft, whether it moves or not.
    [[nodiscard]] bool holds() const noexcept { return enabled() && !off && !measuring; }
    [[nodiscard]] bool enabled() const noexcept { return power == AxisPower::on || power == AxisPower::halt; }
};

}  // namespace axisgate::pacontrol::twin
