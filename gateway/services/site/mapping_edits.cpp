// Edits of mappings: one entry, several, a template of the standard map. The id of another mapping is never taken.
#include <fmt/core.h>

#include <algorithm>
#include <span>
#include <utility>

#include "gateway/registers/register_map.hpp"
#include "gateway/services/site/register_edits.hpp"
#include "gateway/services/site/register_view.hpp"
#include "gateway/services/site/site_change.hpp"
#include "gateway/services/site/site_table.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
/// The site with another list of mappings; a fault in the entry at `place` is reported below it.
Refusable<Site> with_mapping_list(const Site& before, const Families& families, json::array list, std::optional<std::size_t> place) {
    json::object document = to_json(before);
    document["mappings"] = std::move(list);
    return checked_site(document, families, place ? fmt::format("/mappings/{}", *place) : std::string());
}

/// Conflicts are reported again by the lines of the rows, because the id that a row would get is unknown to the client.
void say_mappings(const json::array& list, const Site& before, const Families& families, std::vector<SiteFault>& faults,
                  const CalledRow& called) {
    (void)parse_mappings(list, before, families, faults, called);
}
}  // namespace

const SiteTable mapping_table{"mappings", "id", mappings_from_csv, say_mappings};

const Mapping* mapping_named(const Site& site, std::string_view id) {
    const auto it = std::ranges::find(site.map(), id, &Mapping::id);
    return it == site.map().end() ? nullptr : &*it;
}

Refusable<EditedMapping> with_mapping(const Site& before, const Families& families, const json::object& entry) {
    json::array list = to_json(before.map());
    const std::size_t place = list.size();
    list.push_back(entry);
    auto site = with_mapping_list(before, families, std::move(list), place);
    if (auto* refusal = std::get_if<ServiceRefusal>(&site)) return std::move(*refusal);
    EditedMapping edited{std::get<Site>(std::move(site)), {}};
    if (place < edited.site.map().size()) edited.id = edited.site.map()[place].id;
    return edited;
}

Refusable<EditedMapping> with_mapping_replaced(const Site& before, const Families& families, const std::string& id,
                                               const json::object& entry) {
    const Mapping* replaced = mapping_named(before, id);
    if (!replaced) return no_such("mapping", id);
    const auto place = static_cast<std::size_t>(replaced - before.map().data());
    json::array list = to_json(before.map());
    list[place] = entry;
    auto& o = list[place].get_object();
    if (!o.contains("id")) o["id"] = id;
    auto site = with_mapping_list(before, families, std::move(list), place);
    if (auto* refusal = std::get_if<ServiceRefusal>(&site)) return std::move(*refusal);
    EditedMapping edited{std::get<Site>(std::move(site)), {}};
    edited.id = edited.site.map()[place].id;
    return edited;
}

Refusable<RemovedMappings> without_mappings(const Site& before, const Families& families, const MappingChoice& choice) {
    for (const auto& id : choice.ids.value_or(std::vector<std::string>{})) {
        if (!mapping_named(before, id)) return no_such("mapping", id);
    }
    json::array kept, removed;
    for (const Mapping& m : before.map()) {
        const bool meant = (choice.unit == 0 || m.unit == choice.unit) && (!choice.axis || m.axis == *choice.axis) &&
                           (!choice.ids || std::ranges::find(*choice.ids, m.id) != choice.ids->end());
        if (meant) {
            removed.emplace_back(m.id);
        } else {
            kept.push_back(to_json(m));
        }
    }
    auto site = with_mapping_list(before, families, std::move(kept), std::nullopt);
    if (auto* refusal = std::get_if<ServiceRefusal>(&site)) return std::move(*refusal);
    return RemovedMappings{std::get<Site>(std::move(site)), std::move(removed)};
}

json::object unit_document(const Site& site, std::uint8_t unit, MapGaps of_host) {
    const auto it = site.gaps.find(unit);
    const bool own = it != site.gaps.end();
    const auto used = std::ranges::count(site.map(), unit, &Mapping::unit);
    return {{"unit", std::int64_t{unit}},
            {"gaps", own ? json::value(name_of(it->second)) : json::value()},
            {"shown", name_of(own ? it->second : of_host)},
            {"mappings", used}};
}

json::array units_document(const Site& site, MapGaps of_host) {
    json::array out;
    for (std::uint8_t unit = 2; unit <= 254; ++unit) {
        auto o = unit_document(site, unit, of_host);
        if (!o.at("gaps").is_null() || o.at("mappings") != 0) out.push_back(std::move(o));
    }
    return out;
}

Refusable<std::uint32_t> next_free(const Site& site, std::int64_t unit, MapTable table, std::uint32_t words, std::uint32_t align) {
    auto list = site.map();
    std::ranges::sort(list, {}, &Mapping::address);
    std::uint32_t at = 0;
    for (const auto& m : list) {
        if (m.unit != unit || m.table != table) continue;
        if (m.address >= at + words) break;
        if (m.end() > at) at = (m.end() + align - 1) / align * align;
    }
    if (at + words > 65536)
        return ServiceRefusal{ServiceRefusal::Why::conflict, fmt::format("unit {} has no {} free places in a row", unit, words)};
    return at;
}

TemplateWish read_template_wish(const json::object& body, std::vector<Fault>& faults) {
    for (const auto& [k, v] : body) {
        if (k != "template" && k != "axis" && k != "unit" && k != "address" && k != "dry_run")
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "leave it out"});
    }
    const auto whole = [&](const char* name, std::int64_t low, std::int64_t high) -> std::int64_t {
        const auto* v = body.if_contains(name);
        if (v && v->is_int64() && v->get_int64() >= low && v->get_int64() <= high) return v->get_int64();
        faults.push_back(
            {fmt::format("/{}", name), fmt::format("{} must be a whole number from {} to {}", name, low, high), "write such a number"});
        return low;
    };
    TemplateWish wish;
    const auto* name = body.if_contains("template");
    if (!name || *name != json::value("standard_map"))
        faults.push_back({"/template", "template must be standard_map", "write \"standard_map\""});
    const auto* axis = body.if_contains("axis");
    if (!axis || !axis->is_string())
        faults.push_back({"/axis", "axis must be the name of an axis", "write its name"});
    else
        wish.axis = axis->get_string();
    wish.unit = whole("unit", 2, 254);
    if (body.contains("address")) wish.address = whole("address", 0, 65'535 - 48);
    const auto* dry = body.if_contains("dry_run");
    if (dry && !dry->is_bool()) faults.push_back({"/dry_run", "dry_run must be true or false", "write true or false"});
    wish.dry_run = dry && dry->is_bool() && dry->get_bool();
    return wish;
}

json::array template_entries(const TemplateWish& wish, std::int64_t address, MapWordOrder order) {
    json::array entries;
    for (const auto& s : standard_points()) {
        const auto point = axis_point_named(s.point);
        if (!point) continue;
        entries.push_back(json::object{{"unit", wish.unit},
                                       {"table", "holding_registers"},
                                       {"address", address + s.offset},
                                       {"axis", wish.axis},
                                       {"point", s.point},
                                       {"type", name_of(s.type)},
                                       {"word_order", name_of(order)},
                                       {"access", s.writable ? name_of(MapAccess::read_write) : name_of(MapAccess::read)}});
    }
    return entries;
}

Refusable<AddedMappings> with_mappings(const Site& before, const Families& families, const json::array& entries) {
    json::array list = to_json(before.map());
    const std::size_t had = list.size();
    list.insert(list.end(), entries.begin(), entries.end());
    auto site = with_mapping_list(before, families, std::move(list), std::nullopt);
    if (auto* refusal = std::get_if<ServiceRefusal>(&site)) return std::move(*refusal);
    AddedMappings added{std::get<Site>(std::move(site)), {}};
    added.added = to_json(std::span(added.site.map()).subspan(had));
    return added;
}

}  // namespace axisgate
