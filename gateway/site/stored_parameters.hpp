// What becomes of parameters that were written through the gateway when their drive is found to have other values.
// In: the word of a site. Out: the rule. Never a value.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace axisgate {

enum class StoredParameters : std::uint8_t {
    ignore,   ///< the drive's own count, nobody looks
    compare,  ///< they are read when the drive answers, and a difference is an event
    write     ///< the same, and what differs is written, unless the axis moves
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
