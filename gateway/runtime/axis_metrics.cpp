// Axis metrics: one metric after the other, one line for each axis of which its value is known.
// In: pictures. Out: text. Never asks a drive.
#include "gateway/runtime/axis_metrics.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "gateway/axis/cia402.hpp"

namespace axisgate {
namespace {
/// A label's value: quotes, backslashes and line ends would end it.
std::string label(std::string_view text) {
    std::string s;
    for (const char c : text) {
        if (c == '\n') {
            s += "\\n";
            continue;
        }
        if (c == '"' || c == '\\') s += '\\';
        s += c;
    }
    return s;
}

constexpr std::array states{
    PowerState::not_ready_to_switch_on, PowerState::switch_on_disabled, PowerState::ready_to_switch_on,    PowerState::switched_on,
    PowerState::operation_enabled,      PowerState::quick_stop_active,  PowerState::fault_reaction_active, PowerState::fault};
}  // namespace

std::string axis_metrics(const SiteState& site, std::span<const AxisPicture> pictures, Instant now) {
    std::string s;
    const auto& axes = site.site.axes;
    const std::size_t count = std::min(pictures.size(), axes.size());
    const auto head = [&](std::string_view name, std::string_view help) {
        s += fmt::format("# HELP axisgate_axis_{0} {1}\n# TYPE axisgate_axis_{0} gauge\n", name, help);
    };
    const auto flag = [&](std::string_view name, std::string_view help, std::uint16_t bit) {
        head(name, help);
        for (std::size_t i = 0; i < count; ++i)
            s += fmt::format("axisgate_axis_{}{{axis=\"{}\"}} {}\n", name, axes[i].name, (pictures[i].flags & bit) != 0 ? 1 : 0);
    };
    const auto in_unit = [&](std::string_view name, std::string_view help, auto&& is_known, auto&& increments) {
        head(name, help);
        for (std::size_t i = 0; i < count; ++i) {
            if (!is_known(pictures[i])) continue;
            s += fmt::format("axisgate_axis_{}{{axis=\"{}\",unit=\"{}\"}} {}\n", name, axes[i].name, label(axes[i].unit),
                             static_cast<double>(increments(pictures[i])) / axes[i].increments_per_unit);
        }
    };
    const auto seen = [](const AxisPicture& p) { return p.ever_seen; };
    in_unit("position", "Actual position in the axis' unit.", seen, [](const AxisPicture& p) { return p.position; });
    in_unit("velocity", "Actual velocity in the axis' unit per second.", seen, [](const AxisPicture& p) { return p.velocity; });
    in_unit(
        "following_error", "Demanded less actual position in the axis' unit.",
        [](const AxisPicture& p) { return p.following_error_known(); }, [](const AxisPicture& p) { return p.following_error(); });
    head("age_seconds", "Time since the drive said what is shown.");
    for (std::size_t i = 0; i < count; ++i) {
        if (!pictures[i].ever_seen) continue;
        s += fmt::format("axisgate_axis_age_seconds{{axis=\"{}\"}} {:.3f}\n", axes[i].name,
                         std::max(0.0, std::chrono::duration<double>(now - pictures[i].at).count()));
    }
    head("state", "1: the CiA 402 state that the axis is in.");
    for (std::size_t i = 0; i < count; ++i) {
        const PowerState now_in = power_state_of(pictures[i].statusword);
        for (const PowerState state : states)
            s += fmt::format("axisgate_axis_state{{axis=\"{}\",state=\"{}\"}} {}\n", axes[i].name, name_of(state), state == now_in ? 1 : 0);
    }
    flag("online", "1: the drive or its twin answers.", flag_online);
    flag("simulated", "1: the embedded twin serves the axis.", flag_simulated);
    flag("stale", "1: what is shown is too old to be trusted.", flag_stale);
    flag("moving", "1: the axis moves.", flag_moving);
    flag("referenced", "1: the position has a known zero.", flag_referenced);
    flag("fault", "1: the axis is in fault.", flag_fault);
    return s;
}

}  // namespace axisgate
