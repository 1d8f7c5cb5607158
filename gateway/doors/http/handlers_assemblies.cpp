// Handlers of assemblies: the EtherNet/IP instances of the site's own and of its profiles, and what stands at which byte of them.
// In: calls. Out: entries in their full form, the site's own also as CSV; changes go through parse_site as a whole, like every change of
// the site. Never those that every site has: of axes, heartbeats, configuration.
#include <algorithm>

#include "gateway/doors/http/site_change.hpp"
#include "gateway/doors/http/table_import.hpp"
#include "gateway/registers/profiles/language.hpp"
#include "gateway/site/assembly.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {

Response assembly_answer(const SiteState& now, const json::value& body) {
    Response r = json_response(body);
    put_revision(r, now);
    return r;
}

const AssemblySpec* assembly_of(const Site& site, std::int64_t instance) {
    const auto it = std::ranges::find(site.assemblies, instance, &AssemblySpec::instance);
    return it == site.assemblies.end() ? nullptr : &*it;
}

json::object value_document(std::uint32_t offset, std::uint32_t bytes, std::string_view name, const json::value& axis, MapType type) {
    return {{"offset", std::int64_t{offset}}, {"bytes", std::int64_t{bytes}}, {"name", name}, {"axis", axis}, {"type", name_of(type)}};
}

/// What stands where in the bytes of an assembly, by offset.
json::array values_of(const Site& site, const AssemblySpec& a, const registers::Languages& pages) {
    json::array out;
    const std::uint32_t end = a.address + std::uint32_t{a.registers};
    const bool output = a.direction == AssemblyDirection::output;
    const auto profile = std::ranges::find(site.profiles, a.unit, &ProfileSpec::unit);
    if (profile != site.profiles.end()) {
        const auto& page = pages[static_cast<std::size_t>(profile->language)];
        if (!page) return out;
        for (const auto& r : page->rows) {
            const bool there = (a.table == MapTable::holding_registers ? r.holding : r.input) && (output ? r.writable : r.readable);
            if (!there || r.axis > profile->axes.size() || r.address < a.address || r.end() > end) continue;
            const auto& axis = profile->axes[r.axis == 0 ? 0 : r.axis - 1u].axis;
            const bool of_unit = r.axis == 0 && profile->axes.size() > 1;
            out.push_back(
                value_document(2u * (r.address - a.address), 2u * r.width(), r.name, of_unit ? json::value() : json::value(axis), r.type));
        }
        return out;
    }
    std::vector<const Mapping*> in;
    for (const Mapping& m : site.map()) {
        const bool there = m.unit == a.unit && m.table == a.table && m.access != (output ? MapAccess::read : MapAccess::write);
        if (there && m.address >= a.address && m.end() <= end) in.push_back(&m);
    }
    std::ranges::sort(in, {}, [](const Mapping* m) { return m->address; });
    for (const Mapping* m : in)
        out.push_back(
            value_document(2u * (m->address - std::uint32_t{a.address}), 2u * m->size(), m->point, json::value(m->axis), m->type));
    return out;
}

/// Said again with the rows by their lines, and with what the rest of the site has.
void say_assemblies(const json::array& list, const Site& before, const Families&, std::vector<SiteFault>& faults, const CalledRow& called) {
    Site site = before;
    site.assemblies.clear();
    const json::value entries(list);
    read_assemblies(&entries, site, faults);
    std::vector<SiteFault> more;
    check_assemblies(site, more, called);
    // An entry that could not be read stands for nothing: what it would be in the way of is not told.
    const auto entry_of = [](const SiteFault& f) { return f.pointer.substr(0, f.pointer.find('/', std::size("/assemblies/") - 1)); };
    std::erase_if(more, [&](const SiteFault& f) { return std::ranges::find(faults, entry_of(f), entry_of) != faults.end(); });
    faults.insert(faults.end(), more.begin(), more.end());
}
constexpr TableImport assembly_table{"assemblies", "instance", assemblies_from_csv, say_assemblies};
}  // namespace

Handled list_assemblies(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    json::array out;
    for (const auto& a : assemblies_of(site->site)) {
        json::object o = to_json(a.spec);
        o["byte_order"] = name_of(a.spec.order);
        o["bytes"] = std::int64_t{a.spec.bytes()};
        o["name"] = a.name;
        json::array axes;
        for (const auto& axis : a.axes)
            axes.emplace_back(axis);
        o["axes"] = std::move(axes);
        o["partner"] = a.partner == 0 ? json::value() : json::value(std::int64_t{a.partner});
        o["of_profile"] = assembly_of(site->site, a.spec.instance) == nullptr;
        o["values"] = values_of(site->site, a.spec, c.context.settings.languages);
        out.push_back(std::move(o));
    }
    return assembly_answer(*site, json::object{{"assemblies", std::move(out)}, {"most", static_cast<std::int64_t>(most_assemblies)}});
}

Handled get_assembly(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    const auto instance = parse_whole(c.names[0], 1, 65535);
    const auto* a = instance ? assembly_of(site->site, *instance) : nullptr;
    if (!a) return nothing_named("assembly", c.names[0]);
    return assembly_answer(*site, to_json(*a));
}

Handled get_assemblies_csv(Call&, const SitePort& sites) {
    const auto site = sites.site();
    return table_answer(*site, assembly_table, assemblies_to_csv(site->site.assemblies));
}
Handled replace_assemblies_csv(Call& c, SitePort& sites, const StagePort& staging) {
    return import_table(c, sites, staging, assembly_table, true);
}
Handled add_assemblies_csv(Call& c, SitePort& sites, const StagePort& staging) {
    return import_table(c, sites, staging, assembly_table, false);
}

Handled put_assembly(Call& c, SitePort& sites, const StagePort& staging) {
    const auto instance = parse_whole(c.names[0], 1, 65535);
    if (!instance) return nothing_named("assembly", c.names[0]);
    return change_site(c, sites, staging, false,
                       [&sites, instance = *instance, entry = c.body.get_object()](const SiteState& before) mutable -> Planned {
                           json::object document = to_json(before.site);
                           json::array list;
                           for (const auto& a : before.site.assemblies) {
                               if (a.instance != instance) list.push_back(to_json(a));
                           }
                           entry["instance"] = instance;
                           list.push_back(entry);
                           const std::string place = fmt::format("/assemblies/{}", list.size() - 1);
                           document["assemblies"] = std::move(list);
                           std::vector<SiteFault> faults;
                           auto site = parse_site(document, sites.families(), faults);
                           if (!site) return refusal_for(faults, place, false);
                           return Plan{std::move(*site), [instance](const std::shared_ptr<const SiteState>& now) {
                                           const auto* a = assembly_of(now->site, instance);
                                           return assembly_answer(*now, a ? json::value(to_json(*a)) : json::value());
                                       }};
                       });
}

Handled remove_assembly(Call& c, SitePort& sites, const StagePort& staging) {
    const auto instance = parse_whole(c.names[0], 1, 65535);
    return change_site(c, sites, staging, false, [instance, name = c.names[0]](const SiteState& before) -> Planned {
        if (!instance || !assembly_of(before.site, *instance)) return nothing_named("assembly", name);
        Site site = before.site;
        std::erase_if(site.assemblies, [&](const AssemblySpec& a) { return a.instance == *instance; });
        return Plan{std::move(site), [](const std::shared_ptr<const SiteState>& now) {
                        Response r;
                        r.status = 204;
                        put_revision(r, *now);
                        return r;
                    }};
    });
}

}  // namespace axisgate::http
