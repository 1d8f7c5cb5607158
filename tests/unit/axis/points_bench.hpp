// The table of points with one additional value, for all users of the table: they must show it by this row alone. No row of the program's
// own table reads this part of the picture.
#pragma once

#include "gateway/axis/points.hpp"

namespace axisgate::test {

template <std::size_t n>
consteval std::array<AxisPointRow, n + 1> with(const std::array<AxisPointRow, n>& rows, const AxisPointRow& one) {
    std::array<AxisPointRow, n + 1> out{};
    std::copy(rows.begin(), rows.end(), out.begin());
    out.back() = one;
    return out;
}

/// Its word in user maps, behind those of the program.
inline constexpr auto temperature_point = static_cast<AxisPoint>(axis_point_list.size());
inline constexpr AxisPointRow temperature{
    .name = "temperature",
    .read = [](const AxisPicture& p) -> PointValue { return static_cast<std::int64_t>(p.motion_ticket); },
    .known = [](const AxisPicture& p) { return p.motion_ticket != no_ticket; },
    .document = PointInDocument::value,
    .recipe = PointInRecipe::while_answering,
    .map = temperature_point,
    .sample = "temperature",
    .metric = {200, "temperature_celsius", "Temperature of the drive."},
    .channel = {200, "temperature"},
};
inline constexpr auto more_points = with(axis_point_table, temperature);

}  // namespace axisgate::test
