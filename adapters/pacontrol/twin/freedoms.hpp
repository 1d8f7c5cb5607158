// The freedoms of this family (schema/families/pacontrol.json, "freedoms"), sorted by the part of the twin that has them. Each default is
// the control as the manual shows it, or as the errata list of the family's README decides where the manual is silent.
// Those of one axis are in state.hpp (AxisModel), those of the operating mode in mode.hpp (ModeTimes).
#pragma once

#include "adapters/pacontrol/twin/frame.hpp"
#include "adapters/pacontrol/twin/value.hpp"

namespace axisgate::pacontrol::twin {

/// The answer to a poll while no command is in progress (E-16).
enum class IdlePoll : std::uint8_t { last, empty, none };
/// 0A96, 0A97, 0A98 and 0A9A, which the manual describes but does not list: known; unknown (13h); known, but 0A97 and 0A98 are refused
/// (15h) because the axis has no switch of its own.
enum class Switching : std::uint8_t { unknown, known, no_switch };
/// A message that nobody asked for.
enum class Announcement : std::uint8_t { none, acknowledgement, text };

/// Of the serial slave.
struct AnswerFreedoms {
    FrameRules frames;
    bool silence_answered = false;  ///< a request that breaks off is answered with 11h when its silence is over
    RealForm reals = RealForm::seven_digits;
    IdlePoll idle_poll = IdlePoll::last;
    Announcement at_power_on = Announcement::none;  ///< sent when the control has power
    bool errors_announced = false;                  ///< an acknowledgement is sent when another error number is shown
    Duration parameter_store{};                     ///< after 0700 and 0800: acknowledged so much later, and deaf meanwhile
};

/// Of the commands.
struct ControlFreedoms {
    Duration busy{};                   ///< after a command of the operating mode everything but stops is refused with 15h
    Duration io_scan{};                ///< 1900 to 1903 show inputs and outputs as they were at the last multiple of it; 0: now
    Duration error_shown{};            ///< a new error number is shown so much later ...
    Duration error_cleared{};          ///< ... and its end
    bool reference_at_once = false;    ///< 0A84 is acknowledged with end of processing when the run begins (E-30)
    bool axis_on_awaited = false;      ///< 0A97 has its end of processing when the axis is on
    bool null_references = true;       ///< 0A85 sets the reference flag (E-34)
    bool online_resumes = true;        ///< 0603 is admitted in status 35 (E-20)
    bool reference_outlives = true;    ///< without an absolute system, the reference flag outlives ONLINE
    bool excluded_unanswered = false;  ///< a further command while 0A84, 0A87 or 0A89 runs is not answered, instead of 14h (E-69)
    bool system_elements = true;       ///< 1934, 1935, 1937 are known (E-29)
    Switching switching = Switching::known;
    std::uint16_t wrong_mode = 0x14;  ///< command error in the wrong operating mode (E-21)
};

}  // namespace axisgate::pacontrol::twin
