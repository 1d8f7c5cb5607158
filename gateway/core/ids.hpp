// Ids: the small numbers by which lines, drives, axes, points and tickets are named inside the process.
// In: nothing. Out: strong integer types. Names (text) belong to the site; ids are given out by the engine.
// Never reused while the process runs: a removed drive's id is not given to another.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace axisgate {

enum class LineId : std::uint16_t {};
enum class DriveId : std::uint16_t {};
enum class AxisId : std::uint16_t {};

inline constexpr LineId no_line{0xFFFF};
inline constexpr DriveId no_drive{0xFFFF};
inline constexpr AxisId no_axis{0xFFFF};

[[nodiscard]] constexpr std::uint16_t index_of(LineId id) noexcept { return static_cast<std::uint16_t>(id); }
[[nodiscard]] constexpr std::uint16_t index_of(DriveId id) noexcept { return static_cast<std::uint16_t>(id); }
[[nodiscard]] constexpr std::uint16_t index_of(AxisId id) noexcept { return static_cast<std::uint16_t>(id); }

/// Axes, drives and lines that a site may have, each.
inline constexpr std::size_t max_axes = 1024;

/// Names one Command on its way; exactly one Result carries it back. 0 means "nobody waits".
using Ticket = std::uint64_t;
inline constexpr Ticket no_ticket = 0;

/// One readable or writable value of an axis: a parameter of the family's catalogue.
/// `element` is 0 for plain parameters and the element number for arrays (`count` in the catalogue).
struct Point {
    std::uint16_t parameter = 0;  ///< index into Catalogue::parameters()
    std::uint16_t element = 0;
    auto operator<=>(const Point&) const = default;
};

}  // namespace axisgate

template <>
struct std::hash<axisgate::Point> {
    std::size_t operator()(const axisgate::Point& p) const noexcept {
        return std::hash<std::uint32_t>{}((std::uint32_t{p.parameter} << 16) | p.element);
    }
};
