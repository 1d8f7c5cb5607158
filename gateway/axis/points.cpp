// Words for modes and presence, texts of units, and the lists whose order differs from that of the table.
#include "gateway/axis/points.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate {

std::string_view mode_name(std::int16_t mode) noexcept {
    switch (mode) {
        case cia402::mode_none:
            return "none";
        case cia402::mode_profile_position:
            return "profile_position";
        case cia402::mode_profile_velocity:
            return "profile_velocity";
        case cia402::mode_homing:
            return "homing";
        case cia402::mode_profile_torque:
            return "profile_torque";
        case cia402::mode_interpolated_position:
            return "interpolated_position";
        case cia402::mode_cyclic_position:
            return "cyclic_position";
        case cia402::mode_cyclic_velocity:
            return "cyclic_velocity";
        case cia402::mode_cyclic_torque:
            return "cyclic_torque";
        default:
            return "other";
    }
}

std::string_view name_of(Presence presence) noexcept {
    switch (presence) {
        case Presence::offline:
            return "offline";
        case Presence::device:
            return "device";
        case Presence::twin:
            return "twin";
    }
    return "offline";
}

std::string text_of(PointUnit unit, std::string_view axis_unit) {
    switch (unit) {
        case PointUnit::none:
            return {};
        case PointUnit::increments:
            return "increments";
        case PointUnit::increments_per_s:
            return "increments/s";
        case PointUnit::increments_per_s2:
            return "increments/s^2";
        case PointUnit::axis:
            return std::string(axis_unit);
        case PointUnit::axis_per_s:
            return axis_unit.empty() ? std::string("1/s") : fmt::format("{}/s", axis_unit);
        case PointUnit::ms:
            return "ms";
        case PointUnit::s:
            return "s";
    }
    return {};
}

std::vector<std::string_view> recipe_points(AxisPointRows rows) {
    std::vector<std::string_view> names;
    for (const auto& row : rows)
        if (row.recipe != PointInRecipe::no) names.push_back(row.name);
    return names;
}

std::vector<const AxisPointRow*> in_order(PointPlace AxisPointRow::*list, AxisPointRows rows) {
    std::vector<const AxisPointRow*> out;
    for (const auto& row : rows)
        if ((row.*list).place != 0) out.push_back(&row);
    std::ranges::stable_sort(out, {}, [list](const AxisPointRow* row) { return (row->*list).place; });
    return out;
}

bool same_but_time(const AxisPicture& a, const AxisPicture& b) noexcept { return same_values<axis_point_table>(a, b); }

}  // namespace axisgate
