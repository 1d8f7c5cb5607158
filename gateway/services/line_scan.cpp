// Reads requests for scans and makes their documents; all faults are reported together.
#include "gateway/services/line_scan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "gateway/core/line_uri.hpp"
#include "gateway/core/text.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
constexpr double default_limit_s = 120, most_limit_s = 600;

/// An address as a client writes it: text or number.
std::string address_in(const json::value& v, std::string_view key, std::vector<Fault>& faults) {
    if (v.is_string() && v.get_string().size() <= 64) return std::string(v.get_string());
    if (v.is_int64()) return std::to_string(v.get_int64());
    faults.push_back(
        {fmt::format("/{}", key), fmt::format("{} must be an address", key), "write it as a drive's address: a number or a text"});
    return {};
}

/// True if a line of the site uses this port, under any of its names.
bool is_at(const LineSpec& line, const SystemPort& port) {
    const auto u = parse_line_uri(line.uri);
    if (!u.good()) return false;
    if (port.kind == SystemPort::Kind::can) return u.uri.kind == LineUri::Kind::can && u.uri.interface == port.name;
    return u.uri.kind == LineUri::Kind::serial && (u.uri.path == port.path || u.uri.path == "/dev/" + port.name);
}
}  // namespace

json::object scan_document(const ScanReport& r, std::string_view line) {
    json::array found;
    for (const auto& f : r.found)
        found.push_back({{"address", f.address}, {"family", f.family}, {"text", f.text}, {"known_as", text_or_null(f.known_as)}});
    json::array families;
    for (const auto& p : r.parts)
        families.push_back({{"family", p.family}, {"asked", p.asked}, {"of", p.of}, {"text", p.text}});
    const bool over = r.state != ScanReport::State::running;
    const double progress = r.state == ScanReport::State::none ? 0
                            : r.of == 0                        ? 1
                                                               : static_cast<double>(r.asked) / static_cast<double>(r.of);
    return {{"line", line},
            {"state", name_of(r.state)},
            {"progress", number(over && r.state == ScanReport::State::done ? 1 : progress)},
            {"asked", r.asked},
            {"of", r.of},
            {"families", std::move(families)},
            {"found", std::move(found)},
            {"text", r.text}};
}

std::optional<LinePlace> find_line(const SitePort& sites, const std::string& name) {
    const auto site = sites.site();
    const auto i = index_of_name(site->site.lines, name);
    if (!i || *i >= site->line_ids.size()) return std::nullopt;
    return LinePlace{name, site->line_ids[*i]};
}

ScanWish read_scan_wish(const json::object& body, std::vector<Fault>& faults) {
    ScanWish wish;
    double limit_s = default_limit_s;
    for (const auto& [k, v] : body) {
        if (k == "from") {
            wish.from = address_in(v, k, faults);
        } else if (k == "to") {
            wish.to = address_in(v, k, faults);
        } else if (k == "family") {
            if (v.is_string() && v.get_string().size() <= 64)
                wish.family = std::string(v.get_string());
            else
                faults.push_back({"/family", "family must be a text", "write the name of a family, or leave it out for all of the line"});
        } else if (k == "limit_s") {
            limit_s = v.is_number() ? v.to_number<double>() : 0;
            if (!(limit_s >= 1 && limit_s <= most_limit_s))
                faults.push_back({"/limit_s", fmt::format("limit_s must be a number from 1 to {}", most_limit_s),
                                  "write the seconds that the search may take"});
        } else {
            faults.push_back(
                {"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "use from, to, family, limit_s"});
        }
    }
    if (faults.empty()) wish.limit = Duration{static_cast<std::int64_t>(std::llround(limit_s * 1e9))};
    return wish;
}

json::array host_ports_document(const LinePort& lines, const Site& site) {
    json::array list;
    for (const auto& p : lines.host_ports()) {
        const auto used = std::ranges::find_if(site.lines, [&p](const LineSpec& l) { return is_at(l, p); });
        const std::string uri = p.kind == SystemPort::Kind::can ? "can:" + p.name : "serial:" + p.path;
        list.push_back({{"kind", name_of(p.kind)},
                        {"name", p.name},
                        {"uri", uri},
                        {"text", p.text},
                        {"up", p.up},
                        {"line", text_or_null(used == site.lines.end() ? std::string() : used->name)}});
    }
    return list;
}

}  // namespace axisgate
