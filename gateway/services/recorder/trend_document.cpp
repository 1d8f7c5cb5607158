// Trend document: columns of trends with the names that captures and the API have for them.
// In: stretches in increments. Out: JSON and CSV in units. Never shows a value that nobody told: it is null, or an empty cell.
#include "gateway/services/recorder/trend_document.hpp"

#include <fmt/format.h>

#include <boost/json/array.hpp>
#include <cmath>
#include <optional>

#include "gateway/axis/cia402.hpp"
#include "gateway/core/text.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
/// Smallest (or greatest) value of a point in a column, in units; nothing: it is not known.
std::optional<double> value_of(const TrendAxis& a, const TrendColumn& c, std::string_view point, bool high) {
    const TrendRow& r = high ? c.high : c.low;
    if (point == "position") return static_cast<double>(r.position) / a.scale;
    if (point == "velocity") return static_cast<double>(r.velocity) / a.scale;
    if (!c.low.demand_known) return std::nullopt;
    if (point == "demand") return static_cast<double>(r.demand) / a.scale;
    return static_cast<double>(high ? c.greatest_error : c.least_error) / a.scale;
}
double ms_of(std::int64_t unix_ns) { return static_cast<double>(unix_ns / 1000) / 1000; }

json::value number_or_null(const std::optional<double>& v) { return v && std::isfinite(*v) ? json::value(*v) : json::value(nullptr); }
}  // namespace

json::object trend_document(const TrendAxis& a, const std::vector<std::string>& points, std::int64_t unix_offset_ns) {
    json::array at;
    for (const auto& c : a.stretch.columns)
        at.emplace_back(ms_of(ns_of(c.low.at) + unix_offset_ns));
    json::object shown;
    for (const auto& point : points) {
        if (point == "state") {
            json::array values;
            for (const auto& c : a.stretch.columns)
                values.emplace_back(name_of(power_state_of(c.high.statusword)));
            shown[point] = json::object{{"values", std::move(values)}};
            continue;
        }
        json::array low, high;
        for (const auto& c : a.stretch.columns) {
            low.push_back(number_or_null(value_of(a, c, point, false)));
            high.push_back(number_or_null(value_of(a, c, point, true)));
        }
        if (a.stretch.thinned)
            shown[point] = json::object{{"low", std::move(low)}, {"high", std::move(high)}};
        else
            shown[point] = json::object{{"values", std::move(low)}};
    }
    return {{"axis", a.name},
            {"unit", a.unit},
            {"rate_hz", std::round(a.stretch.rate_hz * 10) / 10},
            {"thinned", a.stretch.thinned},
            {"oldest", a.stretch.oldest ? json::value(ms_of(ns_of(*a.stretch.oldest) + unix_offset_ns)) : json::value(nullptr)},
            {"newest", a.stretch.newest ? json::value(ms_of(ns_of(*a.stretch.newest) + unix_offset_ns)) : json::value(nullptr)},
            {"at", std::move(at)},
            {"points", std::move(shown)}};
}

std::string trend_csv(const std::vector<TrendAxis>& axes, const std::vector<std::string>& points, std::int64_t unix_offset_ns) {
    std::string out = "time,axis,unit";
    for (const auto& p : points)
        out += p == "state" ? ",state" : fmt::format(",{0}_low,{0}_high", p);
    out += "\r\n";
    for (const auto& a : axes) {
        for (const auto& c : a.stretch.columns) {
            out += fmt::format("{},{},{}", format_time(ns_of(c.low.at) + unix_offset_ns), csv_cell(a.name), csv_cell(a.unit));
            for (const auto& p : points) {
                if (p == "state") {
                    out += fmt::format(",{}", name_of(power_state_of(c.high.statusword)));
                    continue;
                }
                for (const bool high : {false, true}) {
                    const auto v = value_of(a, c, p, high);
                    out += v ? fmt::format(",{}", *v) : ",";
                }
            }
            out += "\r\n";
        }
    }
    return out;
}

}  // namespace axisgate
