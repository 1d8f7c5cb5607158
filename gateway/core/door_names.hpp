// The names of doors by their numbers. A door registers its name once (gateway/site/ways_in.hpp); all other code carries the number, and
// looks the name up where it is shown or written. The table only grows and is filled before threads start, so that a look-up is one load.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/command.hpp"

namespace axisgate {

/// Registers the name of a door; the text must live as long as the process. Registering the same pair again is not a fault.
/// Returns an empty string, or the conflict with another door.
[[nodiscard]] std::string name_door(Door door, const std::string_view& name);
/// The door of this name; empty if there is none, and for "none" and "internal".
[[nodiscard]] std::optional<Door> door_named(std::string_view name) noexcept;

}  // namespace axisgate
