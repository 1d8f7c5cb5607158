// The list of the program's doors.
#pragma once

#include <span>
#include <string>

#include "gateway/runtime/door_descriptor.hpp"

namespace axisgate {

[[nodiscard]] std::span<const DoorDescriptor* const> all_doors();
/// Registers all doors, before any document is read and before threads start. Returns an empty string, or the conflict of two doors.
[[nodiscard]] std::string bring_doors();

}  // namespace axisgate
