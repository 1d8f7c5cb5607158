// Handlers of profiles: which units speak another device's language, and what stands where in each language.
// In: calls. Out: the site's profiles with their registers; changes go through parse_site as a whole, like every change of the site.
// Never reads a register.
#include <algorithm>

#include "gateway/doors/http/site_change.hpp"
#include "gateway/registers/profiles/language.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {

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

Response with_revision(const SiteState& now, const json::value& body) {
    Response r = json_response(body);
    put_revision(r, now);
    return r;
}

const ProfileSpec* profile_of(const Site& site, std::int64_t unit) {
    const auto it = std::ranges::find(site.profiles, unit, &ProfileSpec::unit);
    return it == site.profiles.end() ? nullptr : &*it;
}

/// The list of the document without the entry of this unit.
json::array others_than(const Site& site, std::int64_t unit) {
    json::array list;
    for (const auto& p : site.profiles) {
        if (p.unit != unit) list.push_back(to_json(p));
    }
    return list;
}
}  // namespace

Handled list_profiles(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    json::array languages, profiles;
    for (std::size_t i = 0; i < profile_language_count; ++i) {
        if (const auto& page = c.context.settings.languages[i])
            languages.push_back(language_document(static_cast<ProfileLanguage>(i), *page));
    }
    for (const auto& p : site->site.profiles)
        profiles.push_back(to_json(p));
    return with_revision(*site, json::object{{"languages", std::move(languages)}, {"profiles", std::move(profiles)}});
}

Handled get_profile(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    const auto unit = parse_whole(c.names[0], 2, 254);
    const auto* p = unit ? profile_of(site->site, *unit) : nullptr;
    if (!p) return nothing_named("profile of unit", c.names[0]);
    return with_revision(*site, to_json(*p));
}

Handled put_profile(Call& c, SitePort& sites, const StagePort& staging) {
    const auto unit = parse_whole(c.names[0], 2, 254);
    if (!unit) return nothing_named("unit", c.names[0]);
    return change_site(c, sites, staging, false,
                       [&sites, unit = *unit, entry = c.body.get_object()](const SiteState& before) mutable -> Planned {
                           json::object document = to_json(before.site);
                           json::array list = others_than(before.site, unit);
                           entry["unit"] = unit;
                           list.push_back(entry);
                           const std::string place = fmt::format("/profiles/{}", list.size() - 1);
                           document["profiles"] = std::move(list);
                           std::vector<SiteFault> faults;
                           auto site = parse_site(document, sites.families(), faults);
                           if (!site) return refusal_for(faults, place, false);
                           return Plan{std::move(*site), [unit](const std::shared_ptr<const SiteState>& now) {
                                           const auto* p = profile_of(now->site, unit);
                                           return with_revision(*now, p ? json::value(to_json(*p)) : json::value());
                                       }};
                       });
}

Handled remove_profile(Call& c, SitePort& sites, const StagePort& staging) {
    const auto unit = parse_whole(c.names[0], 2, 254);
    return change_site(c, sites, staging, false, [&sites, unit, name = c.names[0]](const SiteState& before) -> Planned {
        if (!unit || !profile_of(before.site, *unit)) return nothing_named("profile of unit", name);
        json::object document = to_json(before.site);
        document["profiles"] = others_than(before.site, *unit);
        std::vector<SiteFault> faults;
        auto site = parse_site(document, sites.families(), faults);  // an assembly may show its unit
        if (!site) return refusal_for(faults, "", false);
        return Plan{std::move(*site), [](const std::shared_ptr<const SiteState>& now) {
                        Response r;
                        r.status = 204;
                        put_revision(r, *now);
                        return r;
                    }};
    });
}

}  // namespace axisgate::http
