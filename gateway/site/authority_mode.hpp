// The site's choice for an axis: whether a command needs a lease. Who may command is decided elsewhere.
#pragma once

#include <cstdint>
#include <string_view>

namespace axisgate {

/// Whether a command needs a lease.
enum class AuthorityMode : std::uint8_t {
    free,  ///< no; but while a client holds a lease, others are refused
    lease  ///< a command takes a lease automatically, and renews it
};
[[nodiscard]] std::string_view name_of(AuthorityMode mode) noexcept;

}  // namespace axisgate
