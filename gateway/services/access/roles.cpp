// The names of the roles, in order of their permissions. An unknown name has no role.
#include "gateway/services/access/roles.hpp"

#include <array>

namespace axisgate {
namespace {
constexpr std::array<std::string_view, 5> names{"none", "viewer", "operator", "engineer", "administrator"};
}  // namespace

std::string_view name_of(Role role) noexcept { return names[static_cast<std::size_t>(role)]; }

std::optional<Role> role_named(std::string_view name) noexcept {
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == name) return static_cast<Role>(i);
    }
    return std::nullopt;
}

}  // namespace axisgate
