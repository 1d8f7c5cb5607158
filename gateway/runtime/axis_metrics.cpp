// One metric after the other, with one line for each axis whose value is known. The state has a line for each possible state; the age is in
// seconds.
#include "gateway/runtime/axis_metrics.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "gateway/axis/cia402.hpp"

namespace axisgate {
namespace {
/// Escapes a label's value: quotes, backslashes and line ends would end it.
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

/// Empty if it is not a number.
std::string number_text(const PointValue& value) {
    if (const auto* b = std::get_if<bool>(&value)) return *b ? "1" : "0";
    if (const auto* n = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *n);
    if (const auto* d = std::get_if<double>(&value)) return fmt::format("{}", *d);
    return {};
}

constexpr std::array states{
    PowerState::not_ready_to_switch_on, PowerState::switch_on_disabled, PowerState::ready_to_switch_on,    PowerState::switched_on,
    PowerState::operation_enabled,      PowerState::quick_stop_active,  PowerState::fault_reaction_active, PowerState::fault};
}  // namespace

std::string axis_metrics(const SiteState& site, std::span<const AxisPicture> pictures, Instant now, AxisPointRows rows) {
    std::string s;
    const auto& axes = site.site.axes;
    const std::size_t count = std::min(pictures.size(), axes.size());
    const auto age = [&](std::size_t i) {
        if (!pictures[i].ever_seen) return;
        s += fmt::format("axisgate_axis_age_seconds{{axis=\"{}\"}} {:.3f}\n", axes[i].name,
                         std::max(0.0, std::chrono::duration<double>(now - pictures[i].at).count()));
    };
    const auto state = [&](std::size_t i) {
        const PowerState now_in = power_state_of(pictures[i].statusword);
        for (const PowerState one : states)
            s += fmt::format("axisgate_axis_state{{axis=\"{}\",state=\"{}\"}} {}\n", axes[i].name, name_of(one), one == now_in ? 1 : 0);
    };
    const auto value = [&](std::size_t i, const AxisPointRow& row) {
        if (!known(row, pictures[i])) return;
        const std::string shown = number_text(measured(row, pictures[i], axes[i].increments_per_unit));
        if (shown.empty()) return;
        const std::string unit = is_axis_unit(row.unit) ? fmt::format(",unit=\"{}\"", label(axes[i].unit)) : std::string();
        s += fmt::format("axisgate_axis_{}{{axis=\"{}\"{}}} {}\n", row.metric.name, axes[i].name, unit, shown);
    };
    for (const AxisPointRow* row : in_order(&AxisPointRow::metric, rows)) {
        s += fmt::format("# HELP axisgate_axis_{0} {1}\n# TYPE axisgate_axis_{0} gauge\n", row->metric.name, row->metric.text);
        for (std::size_t i = 0; i < count; ++i) {
            if (row->name == "age_ms") {
                age(i);
            } else if (row->name == "state") {
                state(i);
            } else {
                value(i, *row);
            }
        }
    }
    return s;
}

}  // namespace axisgate
