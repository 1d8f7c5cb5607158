// The site's rule for parameters that were written through the gateway, if their drive is found to have other values.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace axisgate {

enum class StoredParameters : std::uint8_t {
    ignore,   ///< the drive's values count, without a comparison
    compare,  ///< they are read when the drive answers, and a difference causes an event
    write     ///< like compare, and values that differ are written, unless the axis moves
};

[[nodiscard]] constexpr std::string_view name_of(StoredParameters rule) noexcept {
    return rule == StoredParameters::compare ? "compare" : rule == StoredParameters::write ? "write" : "ignore";
}
[[nodiscard]] constexpr std::optional<StoredParameters> stored_parameters_named(std::string_view name) noexcept {
    for (const auto rule : {StoredParameters::ignore, StoredParameters::compare, StoredParameters::write})
        if (name == name_of(rule)) return rule;
    return std::nullopt;
}

}  // namespace axisgate
