// Handlers of the catalogue: families, their parameters, commands and error codes, which are constant while the program runs.
#include "gateway/core/specimen.hpp"
#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/specimens.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// A list of the family, each entry through `show`.
template <class List, class Show>
Handled list_of(Call& c, const SitePort& sites, List list, Show show) {
    const auto entry = sites.families().find(c.names[0]);
    if (!entry.family || !entry.catalogue) return nothing_named("family", c.names[0]);
    json::array out;
    for (const auto& x : list(*entry.catalogue))
        out.push_back(show(*entry.catalogue, x));
    return json_response(out);
}
}  // namespace

Handled list_families(Call&, const SitePort& sites) {
    json::array out;
    for (const auto& e : sites.families().entries)
        out.push_back(family_document(e));
    return json_response(out);
}

Handled get_family(Call& c, const SitePort& sites) {
    const auto entry = sites.families().find(c.names[0]);
    if (!entry.family || !entry.catalogue) return nothing_named("family", c.names[0]);
    return json_response(family_document(entry));
}

Handled get_specimen(Call& c, const SitePort& sites) {
    const auto entry = sites.families().find(c.names[0]);
    if (!entry.family || !entry.catalogue) return nothing_named("family", c.names[0]);
    if (const std::string wrong = check_specimen(c.names[1]); !wrong.empty()) return problem(404, "not_found", wrong);
    return json_response(specimen_document(*entry.catalogue, c.names[1]));
}

Handled list_family_parameters(Call& c, const SitePort& sites) {
    const auto entry = sites.families().find(c.names[0]);
    if (!entry.family || !entry.catalogue) return nothing_named("family", c.names[0]);
    json::array out;
    for (const auto& p : entry.catalogue->parameters()) {
        const Point point{static_cast<std::uint16_t>(out.size()), p.count ? p.first : std::uint16_t{0}};
        out.push_back(parameter_document(*entry.catalogue, point, p.id));
    }
    return json_response(out);
}

Handled list_family_commands(Call& c, const SitePort& sites) {
    return list_of(
        c, sites, [](const Catalogue& k) { return k.commands(); },
        [](const Catalogue& k, const CatalogueCommand& x) { return command_document(k, x); });
}

Handled list_family_errors(Call& c, const SitePort& sites) {
    return list_of(
        c, sites, [](const Catalogue& k) { return k.errors(); }, [](const Catalogue&, const ErrorCode& e) { return error_document(e); });
}

}  // namespace axisgate::http
