// The roles as one ordered scale; each role includes the permissions of those before it. The role that a route requires is in the router's
// table.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace axisgate {

enum class Role : std::uint8_t {
    none,           ///< nobody: only what is open to all
    viewer,         ///< may read, and stop what moves
    operating,      ///< "operator": may command and acknowledge
    engineer,       ///< parameters, the drive's own language, site and mappings
    administrator,  ///< users, and tokens of other users
};

/// "viewer", "operator", ...; "none".
[[nodiscard]] std::string_view name_of(Role role) noexcept;
/// Empty if it is none of the names; "none" is one of them.
[[nodiscard]] std::optional<Role> role_named(std::string_view name) noexcept;

}  // namespace axisgate
