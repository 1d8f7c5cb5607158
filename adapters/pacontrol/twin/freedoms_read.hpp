// Reads the freedoms of this family out of a setup. They come by TwinSetup::freedoms or, for a twin that is made without a page, as
// options of the same names.
#pragma once

#include "adapters/pacontrol/twin/device.hpp"

namespace axisgate::pacontrol::twin {

/// Fills what is a freedom in `d`. An option that says the same thing in its own words ("model", "measuring", "absolute", "reply_check",
/// "request_check") has precedence. A value that is none stays at its default.
void take_freedoms(const TwinSetup& setup, DeviceSetup& d);

}  // namespace axisgate::pacontrol::twin
