// Handlers of registers as a client of a register door sees them, and of aids for a register map: printable lists, free places, templates.
// The words come from the register image and are decoded by the site's mappings; lists have the revision of registers 18-19.
#include <fmt/core.h>

#include <array>

#include "gateway/doors/http/site_change.hpp"
#include "gateway/services/site/register_edits.hpp"
#include "gateway/services/site/register_view.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
using registers::registers_per_axis;

/// Of 32-bit values of the standard map.
MapWordOrder standard_order(const Call& c) {
    return c.context.settings.low_word_first ? MapWordOrder::low_first : MapWordOrder::high_first;
}

std::optional<MapTable> query_table(const Call& c) { return map_table_named(c.target.query.get("table").value_or("holding_registers")); }
Response no_table() { return bad_query("table", "holding_registers, input_registers, coils or discrete_inputs"); }
}  // namespace

Handled get_registers(Call& c, RegisterPort& image, const SitePort& sites) {
    std::optional<Response> fault;
    const auto unit = query_whole(c, "unit", 0, 255, 1, fault);
    const auto address = query_whole(c, "address", 0, 65535, 0, fault);
    const auto count = query_whole(c, "count", 1, 125, 1, fault);
    if (fault) return *fault;
    const auto table = query_table(c);
    if (!table) return no_table();
    if (address + count > 65536) return bad_query("count", "such that address + count is at most 65536");
    const RegisterRange range{unit, *table, static_cast<std::uint16_t>(address), static_cast<std::uint16_t>(count)};
    image.read_registers(
        static_cast<std::uint8_t>(unit), *table, range.address, range.count,
        [&sites, range, order = standard_order(c), respond = c.respond](const std::optional<registers::RegisterRead>& answer) {
            respond(answer ? json_response(register_document(*sites.site(), range, *answer, order))
                           : problem(503, "busy", "the gateway has too much to do: come again in a moment"));
        });
    return {gateway_limit, problem(504, "time_out", "the gateway did not answer in time")};
}

Handled get_mapping_list(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    constexpr std::array<std::string_view, 3> media{"text/csv", "text/html", "text/plain"}, formats{"csv", "html", "st"};
    const auto wanted = c.target.query.get("format");
    const auto liked = best_accepted(c.request.headers.get("Accept"), media);
    if (!wanted && !liked) return problem(406, "not_acceptable", "this can be given as text/csv, text/html or text/plain");
    const auto format = wanted ? *wanted : formats[*liked];
    const auto revision = mapping_revision_text(site->site);
    const auto rows = listed_mappings(sites, *site);
    Response r;
    if (format == "csv") {
        r.body = list_csv(rows, revision);
        r.headers.set("Content-Type", "text/csv; charset=utf-8");
    } else if (format == "html") {
        r.body = list_html(rows, revision);
        r.headers.set("Content-Type", "text/html; charset=utf-8");
    } else if (format == "st") {
        r.body = list_st(rows, revision);
        r.headers.set("Content-Type", "text/plain; charset=utf-8");
        r.headers.set("Content-Disposition", "attachment; filename=\"registers.st\"");
    } else {
        return bad_query("format", "csv, html or st");
    }
    r.headers.set("Mapping-Revision", revision);
    put_revision(r, *site);
    return r;
}

Handled get_next_free(Call& c, const SitePort& sites) {
    std::optional<Response> fault;
    const auto unit = query_whole(c, "unit", 2, 254, 2, fault);
    const auto words = query_whole(c, "words", 1, 1024, 1, fault);
    // A block of a whole axis is aligned as in the standard map.
    const auto align = query_whole(c, "align", 1, 1024, words == registers_per_axis ? registers_per_axis : 1, fault);
    if (fault) return *fault;
    const auto table = query_table(c);
    if (!table) return no_table();
    return given(next_free(sites.site()->site, unit, *table, static_cast<std::uint32_t>(words), static_cast<std::uint32_t>(align)),
                 [](std::uint32_t at) {
                     return json_response(json::object{{"address", at}});
                 });
}

Handled add_mapping_template(Call& c, SitePort& sites, const StagePort& staging) {
    std::vector<Fault> faults;
    const auto wish = read_template_wish(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    const auto free = wish.address
                          ? Refusable<std::uint32_t>(static_cast<std::uint32_t>(*wish.address))
                          : next_free(sites.site()->site, wish.unit, MapTable::holding_registers, registers_per_axis, registers_per_axis);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&free)) return problem_of(*refusal);
    const auto entries = template_entries(wish, std::get<std::uint32_t>(free), standard_order(c));
    if (!wish.dry_run) {
        return change_site(c, sites, staging, false, [&sites, entries](const SiteState& before) -> Planned {
            auto made = with_mappings(before.site, sites.families(), entries);
            if (auto* refusal = std::get_if<ServiceRefusal>(&made)) return std::move(*refusal);
            auto& [site, added] = std::get<AddedMappings>(made);
            return Plan{std::move(site), [list = std::move(added)](const std::shared_ptr<const SiteState>& now) {
                            return site_answer(*now, json::object{{"dry_run", false}, {"mappings", list}}, 201);
                        }};
        });
    }
    const auto now = sites.site();
    if (auto refusal = precondition(c, sites, *now, false)) return *std::move(refusal);
    return given(with_mappings(now->site, sites.families(), entries), [](const AddedMappings& made) {
        return json_response(json::object{{"dry_run", true}, {"mappings", made.added}});
    });
}

}  // namespace axisgate::http
