// Objects of the simulated servo: the dictionary of a generic CiA 402 drive (CiA 301, CiA 402-2), as its maker would deliver it.
// In: the node number. Out: entries with type, access, bounds and factory value; which of them `save` keeps.
// Never does anything: what an entry means is the servo's and the node's.
#pragma once

#include "gateway/protocols/canopen/dictionary.hpp"

namespace axisgate::cia402_drive::twin {

[[nodiscard]] canopen::Dictionary factory_dictionary(std::uint8_t node);
/// Kept by 1010h: what can be written and configures. Control word, targets, outputs and error list are not.
[[nodiscard]] bool is_stored(canopen::Address address, const canopen::Entry& entry);

}  // namespace axisgate::cia402_drive::twin
