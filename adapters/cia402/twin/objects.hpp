// The object dictionary of a generic CiA 402 drive (CiA 301, CiA 402-2) with factory values, and the objects that `save` stores. The
// meaning of the entries is in the servo and the node.
#pragma once

#include "gateway/protocols/canopen/dictionary.hpp"

namespace axisgate::cia402_drive::twin {

[[nodiscard]] canopen::Dictionary factory_dictionary(std::uint8_t node);
/// Stored by 1010h: objects that can be written and configure the drive; not the control word, targets, outputs or the error list.
[[nodiscard]] bool is_stored(canopen::Address address, const canopen::Entry& entry);

}  // namespace axisgate::cia402_drive::twin
