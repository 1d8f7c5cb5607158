// Handlers of assemblies: the EtherNet/IP instances of the site and of its profiles, with the content of their bytes; the site's own also
// as CSV. Changes go through parse_site as a whole. The assemblies that every site has (axes, heartbeats, configuration) are not included.
#include "gateway/doors/http/site_change.hpp"
#include "gateway/services/site/register_edits.hpp"

namespace axisgate::http {
namespace json = boost::json;

Handled list_assemblies(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    return site_answer(*site, json::object{{"assemblies", assembly_list(site->site, c.context.settings.languages)},
                                           {"most", static_cast<std::int64_t>(most_assemblies)}});
}

Handled get_assembly(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    const auto instance = parse_whole(c.names[0], 1, 65535);
    const auto* a = instance ? assembly_of(site->site, *instance) : nullptr;
    if (!a) return nothing_named("assembly", c.names[0]);
    return site_answer(*site, to_json(*a));
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
    return change_site(c, sites, staging, false, [&sites, instance = *instance, entry = c.body.get_object()](const SiteState& before) {
        return planned(with_assembly(before.site, sites.families(), instance, entry),
                       [instance](const std::shared_ptr<const SiteState>& now) {
                           const auto* a = assembly_of(now->site, instance);
                           return site_answer(*now, a ? json::value(to_json(*a)) : json::value());
                       });
    });
}

Handled remove_assembly(Call& c, SitePort& sites, const StagePort& staging) {
    return change_site(c, sites, staging, false,
                       [name = c.names[0]](const SiteState& before) { return planned(without_assembly(before.site, name), site_without); });
}

}  // namespace axisgate::http
