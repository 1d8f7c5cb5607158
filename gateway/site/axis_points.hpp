// Axis points: the names by which a mapping refers to a value that every axis has in addition to its drive's parameters.
// They are part of the site's document and therefore below the axis in the layers; gateway/axis/points.hpp defines the values.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "gateway/core/value.hpp"

namespace axisgate {

/// The names are those of the register map and of CiA 402; positions and velocities are in the axis' increments, as in the standard map,
/// unless the name ends in _units.
enum class AxisPoint : std::uint8_t {
    statusword,
    mode_display,
    position,
    velocity,
    position_demand,
    following_error,
    error_code,
    flags,
    native_status,
    age_ms,
    setpoints_accepted,
    authority,
    controlword,
    mode,
    target_position,
    profile_velocity,
    profile_acceleration,
    profile_deceleration,
    target_velocity,
    homing_method,
    online,
    simulated,
    stale,
    referenced,
    moving,
    target_reached,
    fault,
    warning,
    position_units,
    velocity_units,
    heartbeat,
    family,
    mapping_revision
};

struct AxisPointInfo {
    AxisPoint point;
    std::string_view name;
    ValueType type;  ///< type of the registers that hold the whole value; those of the standard map have their own
    bool writable;   ///< registers 32..44 of the standard map
    std::string_view description;
    std::array<std::string_view, 2> also{};  ///< longer names that are accepted, too
};

namespace axis_point_list_detail {
using P = AxisPoint;
using enum ValueType;
inline constexpr auto list = std::to_array<AxisPointInfo>({
    {P::statusword, "statusword", u16, false, "CiA 402 status word, with 8 simulated, 14 stale, 15 referenced"},
    {P::mode_display, "mode_display", i16, false, "modes of operation display", {"modes_of_operation_display"}},
    {P::position, "position", i32, false, "position actual value, increments", {"position_actual_value", "position_increments"}},
    {P::velocity, "velocity", i32, false, "velocity actual value, increments/s", {"velocity_actual_value"}},
    {P::position_demand,
     "position_demand",
     i32,
     false,
     "position demand value, increments; the position while nobody says another",
     {"position_demand_value"}},
    {P::following_error,
     "following_error",
     i32,
     false,
     "following error actual value: demand less position, increments; 0 while it is not known",
     {"following_error_actual_value"}},
    {P::error_code, "error_code", u16, false, "the drive's own error code, 0 = none"},
    {P::flags, "flags", u16, false, "0 online, 1 simulated, 2 stale, 3 referenced, 4 moving, 5 target reached, 6 fault, 7 warning"},
    {P::native_status, "native_status", u32, false, "the drive's own status"},
    {P::age_ms, "age_ms", u32, false, "age of the data, ms"},
    {P::setpoints_accepted, "setpoints_accepted", u16, false, "counts up with each accepted set-point"},
    {P::authority, "authority", u16, false, "who commands: 0 none, 1 Modbus, 2 EtherNet/IP, 3 HTTP, 4 DDS"},
    {P::controlword, "controlword", u16, true, "CiA 402 control word"},
    {P::mode, "mode", i16, true, "modes of operation: 1 position, 3 velocity, 6 homing", {"modes_of_operation"}},
    {P::target_position, "target_position", i32, true, "target position, increments"},
    {P::profile_velocity, "profile_velocity", u32, true, "profile velocity, increments/s"},
    {P::profile_acceleration, "profile_acceleration", u32, true, "profile acceleration, increments/s^2"},
    {P::profile_deceleration, "profile_deceleration", u32, true, "profile deceleration, increments/s^2"},
    {P::target_velocity, "target_velocity", i32, true, "target velocity, increments/s"},
    {P::homing_method, "homing_method", i16, true, "CiA 402 homing method"},
    {P::online, "online", boolean, false, "the drive or its model answers"},
    {P::simulated, "simulated", boolean, false, "the drive's model answers"},
    {P::stale, "stale", boolean, false, "the data are too old to be trusted"},
    {P::referenced, "referenced", boolean, false, "the position has a known zero"},
    {P::moving, "moving", boolean, false, "the axis moves"},
    {P::target_reached, "target_reached", boolean, false, "the last motion ended at its target"},
    {P::fault, "fault", boolean, false, "an error that must be reset"},
    {P::warning, "warning", boolean, false, "a warning"},
    {P::position_units, "position_units", f32, false, "position actual value in the axis' unit"},
    {P::velocity_units, "velocity_units", f32, false, "velocity actual value in the axis' unit per second"},
    {P::heartbeat, "heartbeat", u16, false, "counts up each second"},
    {P::family, "family", u16, false, "number of the drive's family"},
    {P::mapping_revision, "mapping_revision", u32, false, "revision of the mapping (hash)"},
});
}  // namespace axis_point_list_detail

/// In the order of AxisPoint.
inline constexpr std::span<const AxisPointInfo> axis_point_list = axis_point_list_detail::list;
static_assert([] {
    for (std::size_t i = 0; i < axis_point_list.size(); ++i)
        if (static_cast<std::size_t>(axis_point_list[i].point) != i) return false;
    return true;
}());

[[nodiscard]] constexpr const AxisPointInfo& info_of(AxisPoint point) noexcept { return axis_point_list[static_cast<std::size_t>(point)]; }
[[nodiscard]] constexpr std::string_view name_of(AxisPoint point) noexcept { return info_of(point).name; }
[[nodiscard]] constexpr bool writable(AxisPoint point) noexcept { return info_of(point).writable; }
/// Finds a point by its name or by one of its longer names.
[[nodiscard]] constexpr std::optional<AxisPoint> axis_point_named(std::string_view name,
                                                                  std::span<const AxisPointInfo> list = axis_point_list) noexcept {
    if (name.empty()) return std::nullopt;
    for (const AxisPointInfo& i : list) {
        if (i.name == name || std::ranges::find(i.also, name) != i.also.end()) return i.point;
    }
    return std::nullopt;
}

}  // namespace axisgate
