// Roles: who may do what, as one ordered scale; each role may do all that those before it may.
// In: names from configuration, records and requests. Out: a Role. Never decides by itself what a route needs: the router's table does.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace axisgate {

enum class Role : std::uint8_t {
    none,           ///< nobody: what is open to all, nothing else
    viewer,         ///< reads; may stop what moves
    operating,      ///< "operator": commands, acknowledges
    engineer,       ///< parameters, the drive's own language, site and mappings
    administrator,  ///< users and other people's tokens
};

/// "viewer", "operator", ...; "none".
[[nodiscard]] std::string_view name_of(Role role) noexcept;
/// Nothing if it is none of the names; "none" is one.
[[nodiscard]] std::optional<Role> role_named(std::string_view name) noexcept;

}  // namespace axisgate
