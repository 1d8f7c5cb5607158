// The options of a simulated drive (DriveSetup) and the conditions around it (Outside).
#pragma once

#include <cstdint>

#include "adapters/linmot/twin/cams.hpp"
#include "adapters/linmot/twin/manners.hpp"

namespace axisgate::linmot::twin {

enum class Series : std::uint8_t { e1100, b1100 };

struct DriveSetup {
    Series series = Series::e1100;
    bool curve_key = true;
    bool force_key = true;
    std::uint16_t force_mask = 0;  ///< control word bits that a parameter forces ...
    std::uint16_t force_word = 0;  ///< ... and their values
    /// An error decelerates the motor, and bit 0 or 1 of the control word is reset before it stands still. True: the error is kept, and the
    /// drive enters its error state. False: it is lost with the power (choice O-39).
    bool keeps_braking_error = true;
    double trig_rise = 500'000;  ///< 0.1 um: target of the command that the run mode defines for rising edges (0DExh) ...
    double trig_fall = 0;        ///< ... and for falling edges (0DFxh); choices, because their parameters have no numbers
    Winding winding;
    Manners manners;
    std::uint64_t seed = 0;  ///< of the noise of the encoder
};

/// The conditions that a tester sets.
struct Outside {
    bool stall = false;
    double lag_ms = 0;                 ///< delay of the actual position behind the demand
    std::uint16_t x4_inputs = 0x0100;  ///< bit 0 = X4.3 ... ; X4.11 (SVE is separate)
    bool safe_voltage_enable = true;
    std::uint16_t x4_mask = 0;  ///< control word bits that come from X4 ...
    std::uint16_t x4_word = 0;
    std::uint16_t panel_mask = 0;  ///< control word bits that a PC tool controls ...
    std::uint16_t panel_word = 0;
    std::uint16_t copy_mask = 0xFFFF;                       ///< control word bits that the interface may set
    std::int64_t analog = 0;                                ///< X4.4
    std::int64_t encoder = 0;                               ///< edges of the master encoder, four per period
    std::int64_t encoder_speed = 0;                         ///< edges/s
    std::int64_t force = 0;                                 ///< 0.1 N
    std::int64_t current = 0;                               ///< mA
    std::int64_t motor_supply = 7200, logic_supply = 2400;  ///< 10 mV
    std::int64_t temperature = 300;                         ///< controller, 0.1 deg C ...
    std::int64_t sensor = 0;                                ///< ... of this sensor, 1..8 in the order of 1BC6h..1BCDh; 0: of all
    bool motor_hot = false, ptc1_hot = false, ptc2_hot = false;
    bool limit_in = false, limit_out = false;
};

}  // namespace axisgate::linmot::twin
