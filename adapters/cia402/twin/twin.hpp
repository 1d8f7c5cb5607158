// The twin of a CiA 402 drive: a node on a CAN line with a servo. It shares no code with the adapter.
#pragma once

#include <memory>

#include "gateway/core/twin.hpp"
#include "gateway/protocols/canopen/eds.hpp"

namespace axisgate::cia402_drive::twin {

/// `description`: its entries replace or extend those of the built-in dictionary. Entries that the model does not know are stored and have
/// no effect; the hand item "unmodelled" has their number. nullptr: the built-in dictionary.
[[nodiscard]] std::unique_ptr<Twin> make_twin(const TwinSetup& setup, const canopen::Eds* description = nullptr);

}  // namespace axisgate::cia402_drive::twin
