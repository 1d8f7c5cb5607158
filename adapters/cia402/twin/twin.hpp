// Twin of any CiA 402 drive: a node on a CAN line with a servo behind it.
// In: setup (node number, options), a description of the maker if there is one. Out: the simulated drive. Shares no code with the adapter.
#pragma once

#include <memory>

#include "gateway/core/twin.hpp"
#include "gateway/protocols/canopen/eds.hpp"

namespace axisgate::cia402_drive::twin {

/// `description`: its entries stand in place of, and beside, those of the built-in dictionary; what the model does not know is stored and
/// does nothing: the hand item "unmodelled" says how many such there are. nullptr: the built-in dictionary alone.
[[nodiscard]] std::unique_ptr<Twin> make_twin(const TwinSetup& setup, const canopen::Eds* description = nullptr);

}  // namespace axisgate::cia402_drive::twin
