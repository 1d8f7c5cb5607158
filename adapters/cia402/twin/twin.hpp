// The twin of a CiA 402 drive: a node on a CAN line with a servo. It shares no code with the adapter.
#pragma once

#include <memory>
#include <span>

#include "gateway/core/twin.hpp"
#include "gateway/protocols/canopen/eds.hpp"

namespace axisgate::cia402_drive::twin {

/// `description`: its entries replace or extend those of the built-in dictionary. Entries that the model does not know are stored and have
/// no effect; the hand item "unmodelled" has their number. nullptr: the built-in dictionary. `freedoms`: those that the hand may change
/// while the twin runs, by name; they are copied. Their values at the beginning are those of the setup.
[[nodiscard]] std::unique_ptr<Twin> make_twin(const TwinSetup& setup, const canopen::Eds* description = nullptr,
                                              std::span<const Freedom> freedoms = {});

}  // namespace axisgate::cia402_drive::twin
