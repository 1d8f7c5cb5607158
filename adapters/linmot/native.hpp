// Native: a client's own telegram as bytes, and what it would do.
// In: text or bytes that a person wrote. Out: bytes, or what is stated by them. Never sends.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::linmot {

/// Pairs of hex digits, blanks and commas between them; nothing: it is no such text.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> native_bytes(std::span<const std::uint8_t> text);
/// Family::stated. Positions in increments of 0.1 um, as the axis has them.
[[nodiscard]] Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body);

}  // namespace axisgate::linmot
