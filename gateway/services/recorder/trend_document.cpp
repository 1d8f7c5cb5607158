// Columns of trends with the names that captures and the API have for them. An unknown value is null, or an empty cell.
#include "gateway/services/recorder/trend_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/json/array.hpp>
#include <cmath>
#include <optional>

#include "gateway/axis/cia402.hpp"
#include "gateway/core/text.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
/// The API's names for the parts of a column. `low` and `high` are the older names of `min` and `max`.
enum class Of : std::uint8_t { first, least, greatest, last };
struct Told {
    std::string_view name;
    Of of;
};
constexpr std::array<Told, 6> told{
    {{"low", Of::least}, {"high", Of::greatest}, {"first", Of::first}, {"min", Of::least}, {"max", Of::greatest}, {"last", Of::last}}};

/// In units; empty if unknown.
std::optional<double> value_of(const TrendAxis& a, const TrendColumn& c, std::string_view point, Of of) {
    const auto channel = std::ranges::find(channel_places, point, &ChannelPlace::name);
    const bool one = of == Of::first || of == Of::last;
    const TrendRow& r = of == Of::first ? c.first : c.last;
    if (channel == channel_places.end() || (one ? !r.known() : !c.known)) return std::nullopt;
    const auto n = one ? channel->of(r) : of == Of::least ? channel->least(c) : channel->greatest(c);
    return n ? std::optional(static_cast<double>(*n) / a.scale) : std::nullopt;
}
double ms_of(std::int64_t unix_ns) { return static_cast<double>(unix_ns / 1000) / 1000; }

json::value number_or_null(const std::optional<double>& v) { return v && std::isfinite(*v) ? json::value(*v) : json::value(nullptr); }
}  // namespace

json::object trend_document(const TrendAxis& a, const std::vector<std::string>& points, std::int64_t unix_offset_ns) {
    json::array at, until, gaps;
    for (const auto& c : a.stretch.columns) {
        at.emplace_back(ms_of(ns_of(c.first.at) + unix_offset_ns));
        until.emplace_back(ms_of(ns_of(c.last.at) + unix_offset_ns));
        gaps.emplace_back(c.gap);
    }
    json::object shown;
    for (const auto& point : points) {
        if (point == "state") {
            json::array values;
            for (const auto& c : a.stretch.columns)
                values.emplace_back(name_of(power_state_of(c.last.statusword)));
            shown[point] = json::object{{"values", std::move(values)}};
            continue;
        }
        const auto values = [&](Of of) {
            json::array list;
            for (const auto& c : a.stretch.columns)
                list.push_back(number_or_null(value_of(a, c, point, of)));
            return list;
        };
        json::object& values_of_point = shown[point].emplace_object();
        if (!a.stretch.thinned) values_of_point["values"] = values(Of::last);
        for (const auto& t : told)
            if (a.stretch.thinned) values_of_point[t.name] = values(t.of);
    }
    json::object out{{"axis", a.name},
                     {"unit", a.unit},
                     {"rate_hz", std::round(a.stretch.rate_hz * 10) / 10},
                     {"thinned", a.stretch.thinned},
                     {"oldest", a.stretch.oldest ? json::value(ms_of(ns_of(*a.stretch.oldest) + unix_offset_ns)) : json::value(nullptr)},
                     {"newest", a.stretch.newest ? json::value(ms_of(ns_of(*a.stretch.newest) + unix_offset_ns)) : json::value(nullptr)},
                     {"at", std::move(at)},
                     {"points", std::move(shown)}};
    if (a.stretch.thinned) {
        out["until"] = std::move(until);
        out["gaps"] = std::move(gaps);
    }
    return out;
}

/// Newer columns follow the older ones, so that programs that read by position still find those.
std::string trend_csv(const std::vector<TrendAxis>& axes, const std::vector<std::string>& points, std::int64_t unix_offset_ns) {
    std::string out = "time,axis,unit";
    for (const auto& p : points)
        out += p == "state" ? ",state" : fmt::format(",{0}_low,{0}_high", p);
    for (const auto& p : points)
        if (p != "state") out += fmt::format(",{0}_first,{0}_last", p);
    out += "\r\n";
    for (const auto& a : axes) {
        for (const auto& c : a.stretch.columns) {
            const auto cell = [&](std::string_view point, Of of) {
                const auto v = value_of(a, c, point, of);
                out += v ? fmt::format(",{}", *v) : ",";
            };
            out += fmt::format("{},{},{}", format_time(ns_of(c.first.at) + unix_offset_ns), csv_cell(a.name), csv_cell(a.unit));
            for (const auto& p : points) {
                if (p == "state") {
                    out += fmt::format(",{}", name_of(power_state_of(c.last.statusword)));
                    continue;
                }
                cell(p, Of::least);
                cell(p, Of::greatest);
            }
            for (const auto& p : points) {
                if (p == "state") continue;
                cell(p, Of::first);
                cell(p, Of::last);
            }
            out += "\r\n";
        }
    }
    return out;
}

}  // namespace axisgate
