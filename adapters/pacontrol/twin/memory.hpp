// The names of the twin's memory, that each part keeps its own values by: `N17`, `system.3`, `axis2.position`.
// In: names, numbers. Out: the same. Never keeps anything: only what differs from the factory state is written, by the part that has it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/text.hpp"
#include "gateway/core/value.hpp"

namespace axisgate::pacontrol::twin {

using Memory = std::map<std::string, Value>;

/// `N17` -> 17 for the prefix `N`; nothing for anything else.
[[nodiscard]] inline std::optional<std::int64_t> numbered(std::string_view name, std::string_view prefix) noexcept {
    return name.starts_with(prefix) ? parse_whole(name.substr(prefix.size()), INT64_MIN, INT64_MAX) : std::nullopt;
}

/// Of axis `n` = 1..16: `axis2.position`.
[[nodiscard]] inline std::string axis_name(int n, std::string_view what) { return "axis" + std::to_string(n) + "." + std::string(what); }

/// The axis whose name this is, and what of it; `n` = 0: of none of `axes`.
struct AxisName {
    int n = 0;
    std::string_view what;
};
[[nodiscard]] inline AxisName axis_named(std::string_view name, int axes) {
    for (int n = 1; n <= axes; ++n) {
        const std::string own = axis_name(n, "");
        if (name.starts_with(own)) return {n, name.substr(own.size())};
    }
    return {};
}

}  // namespace axisgate::pacontrol::twin
