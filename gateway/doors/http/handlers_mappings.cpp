// Handlers of the site's own register maps: the list, one entry, the whole as CSV, and the points that can be mapped.
// In: calls. Out: entries in their full form; changes go through parse_site as a whole, like every change of the site.
// Never reads a register: what an address shows is the Modbus door's.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/axis/points.hpp"
#include "gateway/core/text.hpp"
#include "gateway/doors/http/site_change.hpp"
#include "gateway/doors/http/table_import.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {

std::string_view mapping_id_of(const json::value& mapping) {
    const auto* id = mapping.get_object().if_contains("id");
    return id && id->is_string() ? std::string_view(id->get_string()) : std::string_view();
}
std::optional<std::size_t> place_of(const json::array& mappings, std::string_view id) {
    const auto it = std::ranges::find(mappings, id, mapping_id_of);
    return it == mappings.end() ? std::nullopt : std::optional(static_cast<std::size_t>(it - mappings.begin()));
}
std::string pointer_of(std::size_t i) { return fmt::format("/mappings/{}", i); }

Response shown(const SiteState& now, const json::value& body, unsigned status = 200) {
    Response r = json_response(body, status);
    put_revision(r, now);
    return r;
}

using MappingEdit = std::function<std::optional<Response>(json::array& mappings, std::string& id, std::size_t& place)>;
/// Changes the list, checks the site as a whole, and shows the entry `id`, or nothing if `id` is left empty.
Handled change_mappings(Call& c, SitePort& sites, const StagePort& staging, MappingEdit edit, bool created) {
    return change_site(c, sites, staging, false, [&sites, edit = std::move(edit), created](const SiteState& before) -> Planned {
        json::object document = to_json(before.site);
        json::array& list = document["mappings"].get_array();
        std::string id;
        std::size_t place = list.size();
        if (auto refusal = edit(list, id, place)) return std::move(*refusal);
        std::vector<SiteFault> faults;
        auto site = parse_site(document, sites.families(), faults);
        if (!site) return refusal_for(faults, pointer_of(place), false);
        if (id.empty() && place < site->mappings.size() && created) id = std::string(mapping_id_of(site->mappings[place]));
        return Plan{std::move(*site), [id, created](const std::shared_ptr<const SiteState>& now) {
                        const auto i = place_of(now->site.mappings, id);
                        if (!i) {
                            Response r;
                            r.status = 204;
                            put_revision(r, *now);
                            return r;
                        }
                        Response r = shown(*now, now->site.mappings[*i], created ? 201 : 200);
                        if (created) r.headers.set("Location", "/api/v1/mappings/" + percent_encode(id));
                        return r;
                    }};
    });
}

/// Conflicts are said again with the rows by their lines: an id that a row would get is known to nobody.
void say_mappings(const json::array& list, const Site& before, const Families& families, std::vector<SiteFault>& faults,
                  const CalledRow& called) {
    (void)parse_mappings(list, before, families, faults, called);
}
constexpr TableImport mapping_table{"mappings", "id", mappings_from_csv, say_mappings};

}  // namespace

Handled list_mappings(Call& c, const SitePort& sites) {
    std::optional<Response> fault;
    const std::int64_t unit = query_whole(c, "unit", 2, 254, 0, fault);
    if (fault) return *fault;
    const auto axis = c.target.query.get("axis");
    const auto site = sites.site();
    json::array out;
    for (const auto& m : site->site.mappings) {
        const auto& o = m.get_object();
        if (unit != 0 && o.at("unit") != unit) continue;
        if (axis && o.at("axis").get_string() != *axis) continue;
        out.push_back(m);
    }
    Response r = shown(*site, out);
    r.headers.set("Mapping-Revision", fmt::format("{:08x}", mapping_revision(site->site)));
    return r;
}

Handled get_mapping(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    const auto i = place_of(site->site.mappings, c.names[0]);
    if (!i) return nothing_named("mapping", c.names[0]);
    return shown(*site, site->site.mappings[*i]);
}

Handled add_mapping(Call& c, SitePort& sites, const StagePort& staging) {
    return change_mappings(
        c, sites, staging,
        [entry = c.body.get_object()](json::array& list, std::string&, std::size_t& place) -> std::optional<Response> {
            place = list.size();
            list.push_back(entry);
            return std::nullopt;
        },
        true);
}

Handled replace_mapping(Call& c, SitePort& sites, const StagePort& staging) {
    return change_mappings(
        c, sites, staging,
        [name = c.names[0], entry = c.body.get_object()](json::array& list, std::string& id,
                                                         std::size_t& place) -> std::optional<Response> {
            const auto i = place_of(list, name);
            if (!i) return nothing_named("mapping", name);
            place = *i;
            list[place] = entry;
            auto& o = list[place].get_object();
            if (!o.contains("id")) o["id"] = name;
            id = mapping_id_of(list[place]);
            return std::nullopt;
        },
        false);
}

Handled remove_mapping(Call& c, SitePort& sites, const StagePort& staging) {
    return change_mappings(
        c, sites, staging,
        [name = c.names[0]](json::array& list, std::string&, std::size_t&) -> std::optional<Response> {
            const auto i = place_of(list, name);
            if (!i) return nothing_named("mapping", name);
            list.erase(list.begin() + static_cast<std::ptrdiff_t>(*i));
            return std::nullopt;
        },
        false);
}

Handled remove_mappings(Call& c, SitePort& sites, const StagePort& staging) {
    std::optional<Response> fault;
    const std::int64_t unit = query_whole(c, "unit", 2, 254, 0, fault);
    const bool all = query_flag(c, "all", fault), dry_run = query_flag(c, "dry_run", fault);
    if (fault) return *fault;
    const auto axis = c.target.query.get("axis"), ids = c.target.query.get("ids");
    if (all ? (unit != 0 || axis || ids) : (unit == 0 && !axis && !ids))
        return bad_query("all", "unit, axis, ids or several of them to say which mappings, or all=1 and none of the others");
    std::vector<std::string> wanted;
    for (std::string_view rest = ids ? std::string_view(*ids) : std::string_view(); !rest.empty();) {
        const auto end = std::min(rest.find(','), rest.size());
        wanted.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (ids && wanted.empty()) return bad_query("ids", "ids of mappings with commas between them");
    auto plan = [&sites, unit, wanted, by_id = ids.has_value(),
                 axis = axis ? std::optional<std::string>(*axis) : std::nullopt](const SiteState& before) -> Planned {
        for (const auto& id : wanted) {
            if (!place_of(before.site.mappings, id)) return nothing_named("mapping", id);
        }
        json::object document = to_json(before.site);
        json::array& list = document["mappings"].get_array();
        json::array kept, removed;
        for (auto& m : list) {
            const auto& o = m.get_object();
            const bool meant = (unit == 0 || o.at("unit") == unit) && (!axis || o.at("axis").get_string() == *axis) &&
                               (!by_id || std::ranges::find(wanted, mapping_id_of(m)) != wanted.end());
            (meant ? removed : kept).push_back(meant ? o.at("id") : m);
        }
        list = std::move(kept);
        std::vector<SiteFault> faults;
        auto site = parse_site(document, sites.families(), faults);
        if (!site) return refusal_for(faults, "", false);
        return Plan{std::move(*site), [removed](const std::shared_ptr<const SiteState>& now) {
                        return shown(*now, json::object{{"dry_run", false}, {"removed", removed}, {"mappings", now->site.mappings.size()}});
                    }};
    };
    if (!dry_run) return change_site(c, sites, staging, false, std::move(plan));
    const auto now = sites.site();
    if (auto refusal = precondition(c, sites, *now, false)) return *std::move(refusal);
    auto planned = plan(*now);
    if (auto* refusal = std::get_if<Response>(&planned)) return std::move(*refusal);
    const auto& left = std::get<Plan>(planned).site.mappings;
    json::array removed;
    for (const auto& m : now->site.mappings) {
        if (!place_of(left, mapping_id_of(m))) removed.emplace_back(mapping_id_of(m));
    }
    return shown(*now, json::object{{"dry_run", true}, {"removed", std::move(removed)}, {"mappings", left.size()}});
}

namespace {
json::object unit_document(const SiteState& site, std::uint8_t unit, MapGaps of_host) {
    const auto it = site.site.gaps.find(unit);
    const bool own = it != site.site.gaps.end();
    const auto used =
        std::ranges::count_if(site.site.mappings, [&](const json::value& m) { return m.get_object().at("unit") == std::int64_t{unit}; });
    return {{"unit", std::int64_t{unit}},
            {"gaps", own ? json::value(name_of(it->second)) : json::value()},
            {"shown", name_of(own ? it->second : of_host)},
            {"mappings", used}};
}
}  // namespace

Handled list_mapping_units(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    json::array out;
    for (std::uint8_t unit = 2; unit <= 254; ++unit) {
        auto o = unit_document(*site, unit, c.context.settings.map_gaps);
        if (!o.at("gaps").is_null() || o.at("mappings") != 0) out.push_back(std::move(o));
    }
    return shown(*site, out);
}

Handled change_mapping_unit(Call& c, SitePort& sites, const StagePort& staging) {
    const auto number = parse_whole(c.names[0], 2, 254);
    if (!number) return nothing_named("unit", c.names[0]);
    std::vector<Fault> faults;
    const auto& body = c.body.get_object();
    for (const auto& [k, v] : body) {
        if (k != "gaps")
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)),
                              "write {\"gaps\": \"zero\"}, \"refuse\" or null"});
    }
    const auto* given = body.if_contains("gaps");
    const auto gaps = given && given->is_string() ? map_gaps_named(std::string_view(given->get_string())) : std::nullopt;
    if (!given || (!gaps && !given->is_null()))
        faults.push_back({"/gaps", "gaps must be zero, refuse or null", "null: as the host's [modbus] gaps says"});
    if (!faults.empty()) return invalid(std::move(faults));
    return change_site(
        c, sites, staging, false,
        [unit = static_cast<std::uint8_t>(*number), gaps, of_host = c.context.settings.map_gaps](const SiteState& before) -> Planned {
            Site site = before.site;
            if (gaps)
                site.gaps[unit] = *gaps;
            else
                site.gaps.erase(unit);
            return Plan{std::move(site), [unit, of_host](const std::shared_ptr<const SiteState>& now) {
                            return shown(*now, unit_document(*now, unit, of_host));
                        }};
        });
}

Handled get_mappings_csv(Call&, const SitePort& sites) {
    const auto site = sites.site();
    return table_answer(*site, mapping_table, mappings_to_csv(site->site.map()));
}

Handled replace_mappings_csv(Call& c, SitePort& sites, const StagePort& staging) {
    return import_table(c, sites, staging, mapping_table, true);
}
Handled add_mappings_csv(Call& c, SitePort& sites, const StagePort& staging) {
    return import_table(c, sites, staging, mapping_table, false);
}

Handled list_mapping_points(Call&) {
    json::array out;
    for (const auto& p : axis_point_list) {
        const AxisPointRow& row = *row_of(p.point);
        const bool same = row.document == PointInDocument::value && !row.word;
        out.push_back({{"point", p.name},
                       {"access", p.writable ? "RW" : "R"},
                       {"description", p.description},
                       {"type", name_of(p.type)},
                       {"unit", text_or_null(text_of(row.unit, "unit"))},
                       {"member", same ? json::value(row.name) : json::value(nullptr)}});
    }
    return json_response(out);
}

}  // namespace axisgate::http
