// CAN identifiers: which frames of a CAN line concern a family, as plain data, so that several families can share the line.
// In: identifiers, frames. Out: whether one is among the other.
// Never looks into a frame's data.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "gateway/core/frame.hpp"

namespace axisgate {

/// Frames of one length of identifier with (id & mask) == value.
struct CanIdentifiers {
    bool extended = false;  ///< 29 bits; else 11
    std::uint32_t mask = 0;
    std::uint32_t value = 0;

    [[nodiscard]] constexpr bool holds(const Frame& f) const noexcept { return f.extended == extended && (f.id & mask) == value; }
    /// Some identifier belongs to both.
    [[nodiscard]] constexpr bool meets(const CanIdentifiers& o) const noexcept {
        return extended == o.extended && ((value ^ o.value) & mask & o.mask) == 0;
    }
    bool operator==(const CanIdentifiers&) const = default;
};

[[nodiscard]] inline bool any_holds(std::span<const CanIdentifiers> list, const Frame& frame) noexcept {
    return std::ranges::any_of(list, [&](const CanIdentifiers& i) { return i.holds(frame); });
}

}  // namespace axisgate
