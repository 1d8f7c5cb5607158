// Handlers of the site's own register maps: the list, one entry, all as CSV, and the mappable points. Changes go through parse_site as a
// whole.
#include <fmt/core.h>

#include "gateway/axis/points.hpp"
#include "gateway/core/text.hpp"
#include "gateway/doors/http/site_change.hpp"
#include "gateway/services/site/register_edits.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// An edited entry as a plan: shown after the change, or 204 if it was removed.
Planned entry_plan(Refusable<EditedMapping> edited, bool created) {
    if (auto* refusal = std::get_if<ServiceRefusal>(&edited)) return std::move(*refusal);
    auto& [site, entry] = std::get<EditedMapping>(edited);
    return Plan{std::move(site), [id = std::move(entry), created](const std::shared_ptr<const SiteState>& now) {
                    const Mapping* m = mapping_named(now->site, id);
                    if (!m) return site_without(now);
                    Response r = site_answer(*now, to_json(*m), created ? 201 : 200);
                    if (created) r.headers.set("Location", "/api/v1/mappings/" + percent_encode(id));
                    return r;
                }};
}
}  // namespace

Handled list_mappings(Call& c, const SitePort& sites) {
    std::optional<Response> fault;
    const std::int64_t unit = query_whole(c, "unit", 2, 254, 0, fault);
    if (fault) return *fault;
    const auto axis = c.target.query.get("axis");
    const auto site = sites.site();
    json::array out;
    for (const Mapping& m : site->site.map()) {
        if ((unit == 0 || m.unit == unit) && (!axis || m.axis == *axis)) out.push_back(to_json(m));
    }
    Response r = site_answer(*site, out);
    r.headers.set("Mapping-Revision", fmt::format("{:08x}", mapping_revision(site->site)));
    return r;
}

Handled get_mapping(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    const Mapping* m = mapping_named(site->site, c.names[0]);
    if (!m) return nothing_named("mapping", c.names[0]);
    return site_answer(*site, to_json(*m));
}

Handled add_mapping(Call& c, SitePort& sites, const StagePort& staging) {
    return change_site(c, sites, staging, false, [&sites, entry = c.body.get_object()](const SiteState& before) {
        return entry_plan(with_mapping(before.site, sites.families(), entry), true);
    });
}

Handled replace_mapping(Call& c, SitePort& sites, const StagePort& staging) {
    return change_site(c, sites, staging, false, [&sites, name = c.names[0], entry = c.body.get_object()](const SiteState& before) {
        return entry_plan(with_mapping_replaced(before.site, sites.families(), name, entry), false);
    });
}

Handled remove_mapping(Call& c, SitePort& sites, const StagePort& staging) {
    return change_site(c, sites, staging, false, [&sites, name = c.names[0]](const SiteState& before) -> Planned {
        auto left = without_mappings(before.site, sites.families(), {0, std::nullopt, std::vector{name}});
        if (auto* refusal = std::get_if<ServiceRefusal>(&left)) return std::move(*refusal);
        return Plan{std::get<RemovedMappings>(std::move(left)).site, site_without};
    });
}

Handled remove_mappings(Call& c, SitePort& sites, const StagePort& staging) {
    std::optional<Response> fault;
    MappingChoice choice;
    choice.unit = query_whole(c, "unit", 2, 254, 0, fault);
    const bool all = query_flag(c, "all", fault), dry_run = query_flag(c, "dry_run", fault);
    if (fault) return *fault;
    const auto axis = c.target.query.get("axis"), ids = c.target.query.get("ids");
    if (all ? (choice.unit != 0 || axis || ids) : (choice.unit == 0 && !axis && !ids))
        return bad_query("all", "unit, axis, ids or several of them to say which mappings, or all=1 and none of the others");
    std::vector<std::string> wanted;
    for (std::string_view rest = ids ? std::string_view(*ids) : std::string_view(); !rest.empty();) {
        const auto end = std::min(rest.find(','), rest.size());
        wanted.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (ids && wanted.empty()) return bad_query("ids", "ids of mappings with commas between them");
    if (axis) choice.axis = *axis;
    if (ids) choice.ids = std::move(wanted);
    const auto report = [](const SiteState& now, bool tried, const json::array& removed, std::size_t left) {
        return site_answer(now, json::object{{"dry_run", tried}, {"removed", removed}, {"mappings", left}});
    };
    if (!dry_run) {
        return change_site(c, sites, staging, false, [&sites, choice, report](const SiteState& before) -> Planned {
            auto left = without_mappings(before.site, sites.families(), choice);
            if (auto* refusal = std::get_if<ServiceRefusal>(&left)) return std::move(*refusal);
            auto& [site, ids_of_removed] = std::get<RemovedMappings>(left);
            return Plan{std::move(site), [report, removed = std::move(ids_of_removed)](const std::shared_ptr<const SiteState>& now) {
                            return report(*now, false, removed, now->site.map().size());
                        }};
        });
    }
    const auto now = sites.site();
    if (auto refusal = precondition(c, sites, *now, false)) return *std::move(refusal);
    return given(without_mappings(now->site, sites.families(), choice),
                 [&](const RemovedMappings& left) { return report(*now, true, left.removed, left.site.map().size()); });
}

Handled list_mapping_units(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    return site_answer(*site, units_document(site->site, c.context.settings.map_gaps));
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
                            return site_answer(*now, unit_document(now->site, unit, of_host));
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
