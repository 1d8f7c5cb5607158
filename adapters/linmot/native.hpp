// The bytes of a native telegram, and its effect on the axis, determined before it is sent.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::linmot {

/// Pairs of hex digits, separated by blanks and commas; empty: the text has another form.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> native_bytes(std::span<const std::uint8_t> text);
/// Family::stated. Positions in increments of 0.1 um, as the axis has them.
[[nodiscard]] Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body);

}  // namespace axisgate::linmot
