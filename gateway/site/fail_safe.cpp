// Fail-safe: the names, and the choice of an action: the site's choice for the axis and cause, otherwise the default.
#include "gateway/site/fail_safe.hpp"

#include <algorithm>

namespace axisgate {
namespace {
constexpr std::array<std::string_view, loss_causes.size() + 1> cause_names{
    "none",      "modbus_closed", "modbus_silent", "set_points_silent", "lease_ended",         "enip_closed", "enip_timed_out",
    "enip_idle", "line_lost",     "gateway_ends",  "dds_deadline",      "enip_session_closed", "enip_silent", "motion_unowned"};
constexpr std::array<std::string_view, 4> action_names{"nothing", "halt", "quick_stop", "disable"};
}  // namespace

std::string_view name_of(LossCause cause) noexcept { return cause_names[static_cast<std::size_t>(cause)]; }

std::string_view name_of(FailSafeAction action) noexcept { return action_names[static_cast<std::size_t>(action)]; }

std::optional<FailSafeAction> fail_safe_action_of(std::string_view name) noexcept {
    const auto found = std::ranges::find(action_names, name);
    if (found == action_names.end()) return std::nullopt;
    return static_cast<FailSafeAction>(found - action_names.begin());
}

FailSafeAction FailSafe::action(LossCause cause, const AtLoss& axis) const {
    const auto& wanted = of(cause);
    if (!wanted) {
        if (!axis.moving) return FailSafeAction::nothing;
        if (cause == LossCause::gateway_ends) return FailSafeAction::quick_stop;
        if (cause == LossCause::motion_unowned) return axis.endless ? FailSafeAction::quick_stop : FailSafeAction::nothing;
        return axis.endless ? FailSafeAction::halt : FailSafeAction::nothing;
    }
    if (*wanted == FailSafeAction::disable) return axis.powered || axis.moving ? FailSafeAction::disable : FailSafeAction::nothing;
    return axis.moving ? *wanted : FailSafeAction::nothing;
}

Duration FailSafe::watchdog(Duration by_default) const noexcept {
    return watchdog_ms ? Duration(std::chrono::milliseconds(*watchdog_ms)) : by_default;
}

}  // namespace axisgate
