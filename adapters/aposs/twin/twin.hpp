// The twin of a MACS controller: a node on a CAN line with two axes, a store of parameters and an application that speaks CiA 402. It
// shares no packing code with the adapter.
#pragma once

#include <memory>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::aposs {

[[nodiscard]] std::unique_ptr<Twin> make_twin(const Catalogue& catalogue, const TwinSetup& setup);

}  // namespace axisgate::aposs
