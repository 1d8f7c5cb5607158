// Edits of assemblies and profiles; the assemblies that every site has cannot be edited.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/core/text.hpp"
#include "gateway/services/site/register_edits.hpp"
#include "gateway/services/site/site_change.hpp"
#include "gateway/services/site/site_table.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
json::object value_document(std::uint32_t offset, std::uint32_t bytes, std::string_view name, const json::value& axis, MapType type) {
    return {{"offset", std::int64_t{offset}}, {"bytes", std::int64_t{bytes}}, {"name", name}, {"axis", axis}, {"type", name_of(type)}};
}

/// The values in the bytes of an assembly, by offset.
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

/// Reports faults again by the lines of the rows, including conflicts with the rest of the site.
void say_assemblies(const json::array& list, const Site& before, const Families&, std::vector<SiteFault>& faults, const CalledRow& called) {
    Site site = before;
    site.assemblies.clear();
    const json::value entries(list);
    read_assemblies(&entries, site, faults);
    std::vector<SiteFault> more;
    check_assemblies(site, more, called);
    // An entry that could not be read counts as absent, so its conflicts are not reported.
    const auto entry_of = [](const SiteFault& f) { return f.pointer.substr(0, f.pointer.find('/', std::size("/assemblies/") - 1)); };
    std::erase_if(more, [&](const SiteFault& f) { return std::ranges::find(faults, entry_of(f), entry_of) != faults.end(); });
    faults.insert(faults.end(), more.begin(), more.end());
}

json::object register_document(const registers::LanguageRow& r) {
    const auto number = [](const std::optional<double>& n) { return n ? json::value(*n) : json::value(); };
    json::array tables;
    if (r.holding) tables.emplace_back("holding_registers");
    if (r.input) tables.emplace_back("input_registers");
    json::object o{{"tables", std::move(tables)},
                   {"address", std::int64_t{r.address}},
                   {"type", name_of(r.type)},
                   {"access", !r.readable   ? "W"
                              : !r.writable ? "R"
                                            : "RW"},
                   {"name", r.name},
                   {"description", r.description},
                   {"axis", r.axis == 0 ? json::value() : json::value(std::int64_t{r.axis})},
                   {"min", number(r.min)},
                   {"max", number(r.max)},
                   {"object", nullptr}};
    if (r.object) o["object"] = json::object{{"class", std::int64_t{r.object->class_id}}, {"attribute", std::int64_t{r.object->attribute}}};
    return o;
}

/// The list of the document without the entry of this unit.
json::array other_profiles(const Site& site, std::int64_t unit) {
    json::array list;
    for (const auto& p : site.profiles) {
        if (p.unit != unit) list.push_back(to_json(p));
    }
    return list;
}
}  // namespace

const SiteTable assembly_table{"assemblies", "instance", assemblies_from_csv, say_assemblies};

const AssemblySpec* assembly_of(const Site& site, std::int64_t instance) {
    const auto it = std::ranges::find(site.assemblies, instance, &AssemblySpec::instance);
    return it == site.assemblies.end() ? nullptr : &*it;
}

json::array assembly_list(const Site& site, const registers::Languages& pages) {
    json::array out;
    for (const auto& a : assemblies_of(site)) {
        json::object o = to_json(a.spec);
        o["byte_order"] = name_of(a.spec.order);
        o["bytes"] = std::int64_t{a.spec.bytes()};
        o["name"] = a.name;
        json::array axes;
        for (const auto& axis : a.axes)
            axes.emplace_back(axis);
        o["axes"] = std::move(axes);
        o["partner"] = a.partner == 0 ? json::value() : json::value(std::int64_t{a.partner});
        o["of_profile"] = assembly_of(site, a.spec.instance) == nullptr;
        o["values"] = values_of(site, a.spec, pages);
        out.push_back(std::move(o));
    }
    return out;
}

Refusable<Site> with_assembly(const Site& before, const Families& families, std::int64_t instance, json::object entry) {
    json::array list;
    for (const auto& a : before.assemblies) {
        if (a.instance != instance) list.push_back(to_json(a));
    }
    entry["instance"] = instance;
    list.push_back(std::move(entry));
    const std::string place = fmt::format("/assemblies/{}", list.size() - 1);
    json::object document = to_json(before);
    document["assemblies"] = std::move(list);
    return checked_site(document, families, place);
}

Refusable<Site> without_assembly(const Site& before, const std::string& instance) {
    const auto n = parse_whole(instance, 1, 65535);
    if (!n || !assembly_of(before, *n)) return no_such("assembly", instance);
    Site site = before;
    std::erase_if(site.assemblies, [&](const AssemblySpec& a) { return a.instance == *n; });
    return site;
}

const ProfileSpec* profile_of(const Site& site, std::int64_t unit) {
    const auto it = std::ranges::find(site.profiles, unit, &ProfileSpec::unit);
    return it == site.profiles.end() ? nullptr : &*it;
}

json::object language_document(ProfileLanguage language, const registers::Language& page) {
    json::array rows;
    for (const auto& r : page.rows)
        rows.push_back(register_document(r));
    return {{"language", page.name},
            {"title", page.title},
            {"description", page.description},
            {"source", page.source},
            {"word_order", name_of(page.word_order)},
            {"axes", static_cast<std::int64_t>(most_axes(language))},
            {"registers", std::move(rows)}};
}

Refusable<Site> with_profile(const Site& before, const Families& families, std::int64_t unit, json::object entry) {
    json::array list = other_profiles(before, unit);
    entry["unit"] = unit;
    list.push_back(std::move(entry));
    const std::string place = fmt::format("/profiles/{}", list.size() - 1);
    json::object document = to_json(before);
    document["profiles"] = std::move(list);
    return checked_site(document, families, place);
}

Refusable<Site> without_profile(const Site& before, const Families& families, const std::string& unit) {
    const auto n = parse_whole(unit, 2, 254);
    if (!n || !profile_of(before, *n)) return no_such("profile of unit", unit);
    json::object document = to_json(before);
    document["profiles"] = other_profiles(before, *n);
    return checked_site(document, families, {});  // an assembly may show its unit
}

}  // namespace axisgate
