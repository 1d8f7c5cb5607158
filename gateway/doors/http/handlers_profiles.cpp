// Handlers of profiles: the units with another device's language, and the registers of each language. Changes go through parse_site as a
// whole.
#include "gateway/doors/http/site_change.hpp"
#include "gateway/services/site/register_edits.hpp"

namespace axisgate::http {
namespace json = boost::json;

Handled list_profiles(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    json::array languages, profiles;
    for (std::size_t i = 0; i < profile_language_count; ++i) {
        if (const auto& page = c.context.settings.languages[i])
            languages.push_back(language_document(static_cast<ProfileLanguage>(i), *page));
    }
    for (const auto& p : site->site.profiles)
        profiles.push_back(to_json(p));
    return site_answer(*site, json::object{{"languages", std::move(languages)}, {"profiles", std::move(profiles)}});
}

Handled get_profile(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    const auto unit = parse_whole(c.names[0], 2, 254);
    const auto* p = unit ? profile_of(site->site, *unit) : nullptr;
    if (!p) return nothing_named("profile of unit", c.names[0]);
    return site_answer(*site, to_json(*p));
}

Handled put_profile(Call& c, SitePort& sites, const StagePort& staging) {
    const auto unit = parse_whole(c.names[0], 2, 254);
    if (!unit) return nothing_named("unit", c.names[0]);
    return change_site(c, sites, staging, false, [&sites, unit = *unit, entry = c.body.get_object()](const SiteState& before) {
        return planned(with_profile(before.site, sites.families(), unit, entry), [unit](const std::shared_ptr<const SiteState>& now) {
            const auto* p = profile_of(now->site, unit);
            return site_answer(*now, p ? json::value(to_json(*p)) : json::value());
        });
    });
}

Handled remove_profile(Call& c, SitePort& sites, const StagePort& staging) {
    return change_site(c, sites, staging, false, [&sites, name = c.names[0]](const SiteState& before) {
        return planned(without_profile(before.site, sites.families(), name), site_without);
    });
}

}  // namespace axisgate::http
