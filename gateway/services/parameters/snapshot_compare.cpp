// Compares a snapshot with factory values, the drive, the stored values, another snapshot or another axis. An unknown value is no
// difference, and parameters of two families are never compared.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/text.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/parameters/snapshots.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
using Values = std::map<std::string, Value>;

Values values_of_snapshot(const std::vector<SnapshotValue>& list) {
    Values out;
    for (const auto& v : list)
        out[v.parameter] = v.value;
    return out;
}

/// The missing values of the other side, as text for people: an unknown value is no difference.
std::string unknown_text(std::string_view with, std::size_t unknown, std::size_t all) {
    if (unknown == 0) return {};
    const std::string how_many = unknown == all ? std::string("none of the values") : fmt::format("{} of {} values", unknown, all);
    const std::string is_not = unknown == all ? "is" : "are not";
    if (with == "device") return fmt::format("{} {} be read from the drive", how_many, unknown == all ? "could" : "could not");
    if (with == "stored") return fmt::format("{} {} kept here: only what was written through the gateway is", how_many, is_not);
    if (with.starts_with("axis:") && std::ranges::count(with, ':') == 1)
        return fmt::format("{} {} known of {}: it was not read since the gateway's start; take a snapshot of it and compare with that",
                           how_many, is_not, with.substr(5));
    return fmt::format("{} {} in {}", how_many, is_not, with);
}
}  // namespace

bool equal_values(const Value& a, const Value& b) {
    const auto x = as_number(a), y = as_number(b);
    return x && y ? *x == *y : a == b;
}

std::optional<ServiceRefusal> foreign(const AxisSnapshot& s, std::string_view family, const std::string& what, const std::string& axis) {
    if (s.family.empty() || family.empty() || s.family == family) return std::nullopt;
    return ServiceRefusal{ServiceRefusal::Why::conflict,
                          fmt::format("snapshot {} was taken of a {} drive, {} is of a {}: the same words mean other parameters there", s.n,
                                      s.family, what, family),
                          axis};
}

SnapshotDifference Snapshots::difference(const KeptSnapshot& kept, const std::string& with, const Values& other) const {
    const Catalogue* catalogue = catalogue_of(kept);
    const Values mine = values_of_snapshot(kept.snapshot.parameters);
    std::set<std::string> ids;
    for (const auto& [id, v] : mine)
        ids.insert(id);
    for (const auto& [id, v] : other)
        ids.insert(id);
    SnapshotDifference d;
    d.with = with;
    for (const auto& id : ids) {
        const auto a = mine.find(id), b = other.find(id);
        const auto point = catalogue ? catalogue->find(id) : std::nullopt;
        d.rows.push_back({id, point ? catalogue->parameter(*point) : nullptr, a == mine.end() ? Value{} : a->second,
                          b == other.end() ? Value{} : b->second});
        if (!known(d.rows.back().other)) ++d.not_known;
    }
    if (with != "default") d.text = unknown_text(with, d.not_known, ids.size());
    return d;
}

Refusable<std::optional<Values>> Snapshots::of_axis(const KeptSnapshot& kept, const std::string& with) const {
    const auto& sites = ports_.get<SitePort>();
    const std::string& axis = kept.axis.spec().name;
    std::string name = with.substr(5), number;
    auto other = find_axis(sites, name);
    if (const auto colon = name.rfind(':'); !other && colon != std::string::npos) {
        number = name.substr(colon + 1);
        name.resize(colon);
        other = find_axis(sites, name);
    }
    if (!other) return no_such("axis", name);
    if (!number.empty()) {
        const auto n = parse_whole(number, 1, 0xFFFFFFFF);
        const auto s = n ? ports_.get<SnapshotPort>().snapshot(name, static_cast<std::uint32_t>(*n)) : std::nullopt;
        if (!s) return no_such("snapshot", number);
        if (auto refusal = foreign(kept.snapshot, s->family.empty() ? other->family : s->family, with, axis)) return *std::move(refusal);
        return std::optional(values_of_snapshot(s->parameters));
    }
    if (auto refusal = foreign(kept.snapshot, other->family, "axis " + name, axis)) return *std::move(refusal);
    Values values;
    const KnownParameters known_values(ports_.get<ParameterPort>(), *other);
    for (const auto& v : kept.snapshot.parameters)
        values[v.parameter] = known_values.of(v.parameter);
    return std::optional(std::move(values));
}

Refusable<std::optional<Values>> Snapshots::other_side(const KeptSnapshot& kept, const std::string& with) const {
    if (with.starts_with("axis:")) return of_axis(kept, with);
    const std::string& axis = kept.axis.spec().name;
    if (with.starts_with("snapshot:")) {
        const auto n = parse_whole(std::string_view(with).substr(9), 1, 0xFFFFFFFF);
        const auto other = n ? ports_.get<SnapshotPort>().snapshot(axis, static_cast<std::uint32_t>(*n)) : std::nullopt;
        if (!other) return no_such("snapshot", with.substr(9));
        if (auto refusal = foreign(kept.snapshot, other->family, with, axis)) return *std::move(refusal);
        return std::optional(values_of_snapshot(other->parameters));
    }
    if (auto refusal = why_not_restored(kept)) return *std::move(refusal);
    if (with == "default") {
        Values other;
        for (const auto& v : kept.snapshot.parameters) {
            const auto point = kept.axis.catalogue ? kept.axis.catalogue->find(v.parameter) : std::nullopt;
            if (const auto* p = point ? kept.axis.catalogue->parameter(*point) : nullptr) other[v.parameter] = p->factory_default;
        }
        return std::optional(std::move(other));
    }
    if (with == "stored") return std::optional(KnownParameters(ports_.get<ParameterPort>(), kept.axis).stored());
    if (with == "device") return std::optional<Values>();
    return ServiceRefusal{ServiceRefusal::Why::unreadable, "with must be default, device, stored, snapshot:N, axis:NAME or axis:NAME:N"};
}

void Snapshots::compare(const std::string& axis, std::string_view number, const std::string& with, const Origin& origin,
                        std::function<void(Refusable<SnapshotDifference>)> then) const {
    auto found = find(axis, number);
    if (auto* refusal = std::get_if<ServiceRefusal>(&found)) return then(std::move(*refusal));
    const auto& kept = std::get<KeptSnapshot>(found);
    auto other = other_side(kept, with);
    if (auto* refusal = std::get_if<ServiceRefusal>(&other)) return then(std::move(*refusal));
    if (const auto& values = std::get<std::optional<Values>>(other)) return then(difference(kept, with, *values));
    std::vector<JobPoint> points;
    for (const auto& v : kept.snapshot.parameters) {
        if (const auto point = kept.axis.catalogue ? kept.axis.catalogue->find(v.parameter) : std::nullopt)
            points.push_back({v.parameter, *point});
    }
    const bool started = AxisJobs::start(jobs_, ports_.get<AxisPort>(), axis, kept.axis.id(), std::move(points), false, origin,
                                         [self = *this, kept, with, then](const JobEnd& end) {
                                             if (!end.broken_off.empty())
                                                 return then(job_broken_off(end, kept.axis.spec().name, "nothing was compared"));
                                             then(self.difference(kept, with, values_of_snapshot(end.values)));
                                         });
    if (!started) then(job_busy(axis));
}

json::object document_of(const SnapshotDifference& difference) {
    json::array rows, live;
    for (const auto& row : difference.rows) {
        const auto* p = row.known_as;
        // Parameters that act at once are listed apart: they are no settings, and another value now is no difference.
        auto& list = p && p->live ? live : rows;
        list.push_back(json::object{{"parameter", row.parameter},
                                    {"name", p ? json::value(p->name) : json::value()},
                                    {"unit", p ? text_or_null(p->unit) : json::value()},
                                    {"snapshot", to_json(row.snapshot)},
                                    {"other", to_json(row.other)},
                                    {"other_known", known(row.other)},
                                    {"same", equal_values(row.snapshot, row.other)},
                                    {"writable", p && p->writable()}});
    }
    return {{"with", difference.with},
            {"not_known", difference.not_known},
            {"text", difference.text},
            {"rows", std::move(rows)},
            {"live", std::move(live)}};
}

json::object document_of(const SnapshotInfo& s, const std::string& axis) {
    return {{"n", s.n},
            {"axis", axis},
            {"name", s.name},
            {"comment", s.comment},
            {"at", format_time(s.at_unix_ns)},
            {"who", text_or_null(s.who)},
            {"family", text_or_null(s.family)},
            {"values", s.values}};
}

}  // namespace axisgate
