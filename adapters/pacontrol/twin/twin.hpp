// The embedded model of the IEF Werner PA-CONTROL: byte-exact on its serial port COM1.
// In: the line's bytes, time, the tester's hand. Out: bytes; its non-volatile memory.
// Never includes the adapter or its packing code: it is the second, independent reading of the manual.
#pragma once

#include <memory>

#include "gateway/core/twin.hpp"

namespace axisgate {
class Catalogue;
}

namespace axisgate::pacontrol::twin {

/// Makes one control, without power until `power_on`. Point to point: `setup.address` is not used.
///
/// `setup.axes`: axes that the control has, 1..16 (others are held to that).
/// `setup.freedoms`: the page's, by name (freedoms.hpp); what the twin itself does not have is with_common_freedoms'.
/// `setup.options`, the line's and the drive's; a freedom by its name, where `setup.freedoms` does not have it; other names, and values
/// that cannot be read, are left alone:
///   "reply_check"   "etx" (default: XOR of text and ETX, as nine of the ten printed acknowledgements), "text" (without ETX, as the
///                   tenth), "zero"
///   "request_check" "strict" (default: XOR of the text, or 0), "lenient": also that XOR 3
///   "model"         "ep" (default), "other": no encoder, no temperature, no change of speed while moving
///   "measuring"     "on" (default), "off": the option measuring mode is missing (6Ch)
///   "absolute"      "on" (default), "off": factory value of axis parameter 25h; off: unreferenced at position 0 after power on
///   "switch_on_mode"      0..4, default 1: an interrupted traverse at axis ON: 0 dropped, 1..4 goes on, 4 with watch on displacement
///   "max_displacement"    AE, default 1: what an axis may be displaced while off (switch_on_mode 4)
///   "manual_speed"  "manual" (default: axis parameter 03 for 0A90/0A91), "traverse"
///   "programs"      AUTOMATIC programs: `NAME:MS` or `NAME:MS:ERROR`, separated by commas; default `START:10000`. The first is the
///                   START program; up to 32.
///   "lasting_errors"      numbers separated by commas, default 205: errors of class 2 that 0909 cannot reset
///   "axis_modules"  "on": the Profibus axis extension is configured, axis commands of the CMD interface are refused (14h); "off" default
[[nodiscard]] std::unique_ptr<Twin> make_twin(const Catalogue& catalogue, const TwinSetup& setup);

}  // namespace axisgate::pacontrol::twin
