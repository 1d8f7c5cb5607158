// The members of an axis' document that tell its state in one value each: what a page shows, what a condition of a recipe can look at,
// and what a request to change an axis may carry along without meaning it. One list, so that these three cannot differ.
// In and out: names.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace axisgate {

inline constexpr std::array<std::string_view, 34> axis_state_members{"online",
                                                                     "simulated",
                                                                     "stale",
                                                                     "presence",
                                                                     "state",
                                                                     "statusword",
                                                                     "controlword",
                                                                     "mode",
                                                                     "mode_number",
                                                                     "moving",
                                                                     "target_reached",
                                                                     "referenced",
                                                                     "fault",
                                                                     "warning",
                                                                     "internal_limit",
                                                                     "fail_safe_cause",
                                                                     "stop_latch",
                                                                     "position",
                                                                     "demand_known",
                                                                     "demand_source",
                                                                     "position_demand",
                                                                     "following_error",
                                                                     "velocity",
                                                                     "target_position",
                                                                     "target_velocity",
                                                                     "position_increments",
                                                                     "position_demand_increments",
                                                                     "following_error_increments",
                                                                     "velocity_increments",
                                                                     "target_position_increments",
                                                                     "native",
                                                                     "authority",
                                                                     "setpoints_accepted",
                                                                     "age_ms"};
[[nodiscard]] constexpr bool is_axis_state_member(std::string_view name) noexcept {
    return std::ranges::find(axis_state_members, name) != axis_state_members.end();
}

}  // namespace axisgate
