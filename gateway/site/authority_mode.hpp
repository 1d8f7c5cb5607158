// AuthorityMode: what the site chooses for an axis: whether commanding it takes a lease.
// In and out: a value. Never decides who may command.
#pragma once

#include <cstdint>
#include <string_view>

namespace axisgate {

/// Whether a command needs a lease.
enum class AuthorityMode : std::uint8_t {
    free,  ///< no; but while somebody holds one, the others are refused
    lease  ///< a command takes one by itself, and renews it
};
[[nodiscard]] std::string_view name_of(AuthorityMode mode) noexcept;

}  // namespace axisgate
