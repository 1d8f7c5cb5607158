// The small numbers by which lines, drives, axes, points and tickets are named inside the process. The engine assigns them to the names of
// the site. An id is never reused while the process runs.
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

/// The number of axes, drives and lines that a site may have, each.
inline constexpr std::size_t max_axes = 1024;

/// Identifies one Command in progress; exactly one Result contains it. 0 means that nobody waits for the result.
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
