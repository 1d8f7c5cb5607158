// The CAN identifiers that belong to a family, as plain data, so that several families can share a line. The data of frames are not used.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "gateway/core/frame.hpp"

namespace axisgate {

/// Frames with one length of identifier and (id & mask) == value.
struct CanIdentifiers {
    bool extended = false;  ///< 29 bits; otherwise 11
    std::uint32_t mask = 0;
    std::uint32_t value = 0;

    [[nodiscard]] constexpr bool holds(const Frame& f) const noexcept { return f.extended == extended && (f.id & mask) == value; }
    /// True if some identifier belongs to both.
    [[nodiscard]] constexpr bool meets(const CanIdentifiers& o) const noexcept {
        return extended == o.extended && ((value ^ o.value) & mask & o.mask) == 0;
    }
    bool operator==(const CanIdentifiers&) const = default;
};

[[nodiscard]] inline bool any_holds(std::span<const CanIdentifiers> list, const Frame& frame) noexcept {
    return std::ranges::any_of(list, [&](const CanIdentifiers& i) { return i.holds(frame); });
}

}  // namespace axisgate
