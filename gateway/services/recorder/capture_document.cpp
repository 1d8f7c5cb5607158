// Columns by axis; the names of its members are those of trends. When a document is read, each member is checked.
#include "gateway/services/recorder/capture_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gateway/core/text.hpp"
#include "gateway/services/recorder/channels.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
/// The instant, the numeric channels, and the word that contains the state.
constexpr auto columns_of = [] {
    std::array<std::string_view, level_points.size() + 2> names{"seconds"};
    std::ranges::copy(level_points, names.begin() + 1);
    names.back() = "statusword";
    return names;
}();

double seconds_of(Duration d) { return std::chrono::duration<double>(d).count(); }
double ms_of(Duration d) { return std::chrono::duration<double, std::milli>(d).count(); }
json::value time_or_null(std::optional<Instant> at, std::int64_t unix_offset_ns) {
    return at ? json::value(format_time(ns_of(*at) + unix_offset_ns)) : json::value(nullptr);
}

json::object trigger_of(const CaptureOrder& o) {
    const CaptureTrigger& t = o.wish.trigger;
    constexpr std::array<std::string_view, 4> kinds{"at_once", "level", "state", "command"};
    json::object out{{"kind", kinds[static_cast<std::size_t>(t.kind)]}};
    double scale = 1;
    for (std::size_t i = 0; i < o.axes.size(); ++i) {
        if (o.wish.axes[i] == t.axis) out["axis"] = o.axes[i].name, scale = o.axes[i].scale;
    }
    if (t.kind == CaptureTrigger::Kind::level) {
        out["point"] = name_of(t.point);
        out["level"] = static_cast<double>(t.level) / scale;
    }
    if (t.kind == CaptureTrigger::Kind::state) out["state"] = capture_state_name(t.state);
    if (t.kind == CaptureTrigger::Kind::level || t.kind == CaptureTrigger::Kind::state) out["edge"] = t.rising ? "rising" : "falling";
    return out;
}
}  // namespace

json::object capture_summary(const CaptureOrder& o, const Capture& c, std::int64_t unix_offset_ns) {
    json::array axes;
    for (std::size_t i = 0; i < o.axes.size(); ++i) {
        axes.push_back(json::object{{"axis", o.axes[i].name},
                                    {"unit", o.axes[i].unit},
                                    {"rows", c.rows(i).size()},
                                    {"rate_hz", std::round(c.rate_hz(i) * 10) / 10}});
    }
    return {{"name", o.name},
            {"state", name_of(c.state())},
            {"why", text_or_null(c.why())},
            {"who", text_or_null(o.who)},
            {"armed_at", time_or_null(c.armed_at(), unix_offset_ns)},
            {"triggered_at", time_or_null(c.triggered_at(), unix_offset_ns)},
            {"trigger", trigger_of(o)},
            {"wanted_hz", std::round(1 / seconds_of(o.wish.period))},
            {"before_ms", ms_of(o.wish.before)},
            {"after_ms", ms_of(o.wish.after)},
            {"wait_ms", ms_of(o.wish.wait)},
            {"axes", std::move(axes)}};
}

json::array capture_columns(const CaptureOrder& o, const Capture& c) {
    json::array out;
    const Instant zero = c.triggered_at().value_or(c.armed_at());
    for (std::size_t i = 0; i < o.axes.size(); ++i) {
        std::array<json::array, columns_of.size()> columns;
        for (auto& column : columns)
            column.reserve(c.rows(i).size());
        const double scale = o.axes[i].scale;
        for (const TrendRow& r : c.rows(i)) {
            columns[0].emplace_back(seconds_of(r.at - zero));
            for (std::size_t k = 0; k < channel_places.size(); ++k) {
                const auto n = channel_places[k].of(r);
                columns[k + 1].push_back(n ? json::value(static_cast<double>(*n) / scale) : json::value(nullptr));
            }
            columns.back().emplace_back(r.statusword);
        }
        json::object axis{{"axis", o.axes[i].name}, {"unit", o.axes[i].unit}};
        for (std::size_t k = 0; k < columns.size(); ++k)
            axis[columns_of[k]] = std::move(columns[k]);
        out.push_back(std::move(axis));
    }
    return out;
}

std::string capture_csv(const json::array& list) {
    std::string out = fmt::format("{},axis,unit", columns_of[0]);
    for (std::size_t k = 1; k < columns_of.size(); ++k)
        out += fmt::format(",{}", columns_of[k]);
    out += "\r\n";
    for (const auto& v : list) {
        const auto* o = v.if_object();
        if (!o) continue;
        std::array<const json::array*, columns_of.size()> columns{};
        bool whole = true;
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const auto* column = o->if_contains(columns_of[k]);
            columns[k] = column ? column->if_array() : nullptr;
            whole = whole && columns[k] && columns[k]->size() == columns[0]->size();
        }
        const auto *name = o->if_contains("axis"), *unit = o->if_contains("unit");
        if (!whole || !name || !name->is_string() || !unit || !unit->is_string()) continue;
        const std::string who = csv_cell(std::string(name->get_string())) + "," + csv_cell(std::string(unit->get_string()));
        const auto number = [](const json::value& x) { return x.is_number() ? fmt::format("{}", x.to_number<double>()) : std::string(); };
        for (std::size_t i = 0; i < columns[0]->size(); ++i) {
            out += fmt::format("{},{}", number((*columns[0])[i]), who);
            for (std::size_t k = 1; k < columns.size(); ++k)
                out += "," + number((*columns[k])[i]);
            out += "\r\n";
        }
    }
    return out;
}

}  // namespace axisgate
