// The twin of a LinMot E1100 or B1100 drive on a LinRS line. It shares no code with the adapter: it is a second, independent reading of the
// manuals.
#pragma once

#include <memory>

#include "gateway/core/twin.hpp"

namespace axisgate {
class Catalogue;
}

namespace axisgate::linmot::twin {

/// Makes one drive, without power until `power_on`. `setup.address`: its ID, 0..255. `setup.options`, others are left alone:
///   "checksum", "checksum_from", "checksum_start": as for the line (README)
///   "series"  "e1100" (default), "b1100"; "keys" "both" (default), "curve", "force", "none"
///   "force"   control word bits that a parameter forces to 1, decimal
[[nodiscard]] std::unique_ptr<Twin> make_twin(const Catalogue& catalogue, const TwinSetup& setup);

}  // namespace axisgate::linmot::twin
