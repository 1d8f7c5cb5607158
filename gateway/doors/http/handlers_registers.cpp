// Handlers of registers as a client of a register door sees them, and of what helps to lay a register map out: printable lists, free
// places, templates. In: calls. Out: words and bits of the register image, decoded by the site's mappings; lists with the revision of
// registers 18-19. Never renders a register: what is shown is what the image answers, refusals under Modbus' exception codes.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <tuple>

#include "gateway/doors/http/site_change.hpp"
#include "gateway/registers/register_lists.hpp"
#include "gateway/registers/register_map.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {

std::optional<MapTable> table_named(std::string_view name) {
    for (const auto t : {MapTable::coils, MapTable::discrete_inputs, MapTable::holding_registers, MapTable::input_registers}) {
        if (name == name_of(t)) return t;
    }
    return std::nullopt;
}
bool is_bits(MapTable t) { return t == MapTable::coils || t == MapTable::discrete_inputs; }

std::string_view exception_text(unsigned code) {
    switch (code) {
        case 1:
            return "illegal function";
        case 2:
            return "illegal data address: nothing is mapped there";
        case 3:
            return "illegal data value: the range cuts a value in two, or is too long";
        case 4:
            return "server device failure: the drive refused or failed";
        case 6:
            return "server device busy: the value is not known yet, ask again";
        case 0x0A:
            return "gateway path unavailable: no such unit, or the axis is not configured";
        case 0x0B:
            return "gateway target device failed to respond: the drive does not answer";
        default:
            return "exception";
    }
}

std::string revision_text(const SiteState& site) { return fmt::format("{:08x}", mapping_revision(site.site)); }

/// What the point of a mapping is measured in, before scale and offset; empty: nothing.
std::string unit_of_value(const Mapping& m, const SiteState& site, const SitePort& sites) {
    const auto* axis = site.site.axis(m.axis);
    if (const auto* point = std::get_if<AxisPoint>(&m.what))
        return std::string(unit_of(*point, axis ? std::string_view(axis->unit) : std::string_view()));
    const auto place = find_axis(sites, m.axis);
    const auto* p = place && place->catalogue ? place->catalogue->parameter(std::get<Point>(m.what)) : nullptr;
    return p ? p->unit : std::string();
}

/// Of the standard map, what is a value of its own: all but the parameter channel, which comes last.
std::span<const registers::RegisterRow> standard_points() {
    const auto rows = registers::standard_registers();
    return rows.first(static_cast<std::size_t>(std::ranges::find(rows, std::string_view(), &registers::RegisterRow::point) - rows.begin()));
}
using registers::is_standard_unit, registers::registers_per_axis;

/// Of 32-bit values of the standard map.
MapWordOrder standard_order(const Call& c) {
    return c.context.settings.low_word_first ? MapWordOrder::low_first : MapWordOrder::high_first;
}

std::string reason_text(const Value& v) {
    const auto n = as_integer(v).value_or(-1);
    return n >= 0 && n <= static_cast<int>(Reason::internal) ? std::string(axisgate::name_of(static_cast<Reason>(n))) : to_text(v);
}

json::array decoded(const SiteState& site, std::int64_t unit, MapTable table, std::uint32_t address, std::uint32_t count,
                    const std::vector<std::uint8_t>& data, MapWordOrder standard_order) {
    json::array out;
    const auto put = [&](std::uint32_t at, const char* what, std::string_view name, const Mapping& m, std::string_view unit_text) {
        Value v;
        if (is_bits(table)) {
            const auto bit = at - address;
            v = (data[bit / 8] >> (bit % 8) & 1) != 0;
        } else {
            v = decode(m, data.data() + std::size_t{2} * (at - address));
        }
        out.push_back(json::object{{"address", at},
                                   {what, name},
                                   {"type", name_of(m.type)},
                                   {"value", to_json(v)},
                                   {"unit", text_or_null(unit_text)},
                                   {"text", name.ends_with(".refusal_reason") ? reason_text(v) : to_text(v)}});
    };
    if (is_standard_unit(unit)) {
        if (is_bits(table)) return out;
        for (const auto& axis : site.site.axes) {
            for (const auto& s : standard_points()) {
                Mapping m;
                m.type = s.type;
                m.word_order = standard_order;
                m.address = static_cast<std::uint16_t>((static_cast<std::uint32_t>(axis.number) - 1) * registers_per_axis + s.offset);
                if (m.address < address || m.end() > address + count) continue;
                put(m.address, "name", fmt::format("{}.{}", axis.name, s.point), m, "");
            }
        }
        return out;
    }
    for (const auto& m : site.site.map()) {
        if (m.unit != unit || m.table != table || m.address < address || m.end() > address + count) continue;
        const auto* axis = site.site.axis(m.axis);
        put(m.address, "mapping", m.id, m, m.point.ends_with("_units") && axis ? std::string_view(axis->unit) : std::string_view());
    }
    return out;
}

}  // namespace

Handled get_registers(Call& c, RegisterPort& image, const SitePort& sites) {
    std::optional<Response> fault;
    const auto unit = query_whole(c, "unit", 0, 255, 1, fault);
    const auto address = query_whole(c, "address", 0, 65535, 0, fault);
    const auto count = query_whole(c, "count", 1, 125, 1, fault);
    if (fault) return *fault;
    const auto table = table_named(c.target.query.get("table").value_or("holding_registers"));
    if (!table) return bad_query("table", "holding_registers, input_registers, coils or discrete_inputs");
    if (address + count > 65536) return bad_query("count", "such that address + count is at most 65536");
    const auto a = static_cast<std::uint16_t>(address), n = static_cast<std::uint16_t>(count);
    image.read_registers(static_cast<std::uint8_t>(unit), *table, a, n,
                         [&sites, unit, table = *table, a, n, order = standard_order(c),
                          respond = c.respond](const std::optional<registers::RegisterRead>& answer) {
                             if (!answer) return respond(problem(503, "busy", "the gateway has too much to do: come again in a moment"));
                             json::object o{{"unit", unit},
                                            {"table", name_of(table)},
                                            {"address", a},
                                            {"count", n},
                                            {is_bits(table) ? "bits" : "words", json::array()},
                                            {"exception", json::value()},
                                            {"decoded", json::array()}};
                             if (answer->verdict != registers::Verdict::good) {
                                 const auto code = static_cast<unsigned>(answer->verdict);
                                 o["exception"] = json::object{{"code", code}, {"text", exception_text(code)}};
                                 return respond(json_response(o));
                             }
                             const auto& data = answer->bytes;
                             json::array list;
                             for (std::uint32_t i = 0; i < n; ++i) {
                                 if (is_bits(table))
                                     list.emplace_back((data[i / 8] >> (i % 8) & 1) != 0);
                                 else
                                     list.emplace_back(data[2 * i] << 8 | data[2 * i + 1]);
                             }
                             o[is_bits(table) ? "bits" : "words"] = std::move(list);
                             o["decoded"] = decoded(*sites.site(), unit, table, a, n, data, order);
                             respond(json_response(o));
                         });
    return {gateway_limit, problem(504, "time_out", "the gateway did not answer in time")};
}

Handled get_mapping_list(Call& c, const SitePort& sites) {
    const auto site = sites.site();
    auto list = site->site.map();
    std::ranges::sort(list, [](const Mapping& a, const Mapping& b) {
        return std::tuple(a.unit, a.table, a.address) < std::tuple(b.unit, b.table, b.address);
    });
    constexpr std::array<std::string_view, 3> media{"text/csv", "text/html", "text/plain"}, formats{"csv", "html", "st"};
    const auto given = c.target.query.get("format");
    const auto liked = best_accepted(c.request.headers.get("Accept"), media);
    if (!given && !liked) return problem(406, "not_acceptable", "this can be given as text/csv, text/html or text/plain");
    const auto format = given ? *given : formats[*liked];
    const auto revision = revision_text(*site);
    std::vector<ListedMapping> rows;
    for (auto& m : list) {
        std::string unit = unit_of_value(m, *site, sites);
        rows.push_back({std::move(m), std::move(unit)});
    }
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

namespace {
/// The first place with so many free registers, or bits, in a row, at a multiple of `align`.
std::optional<std::uint32_t> next_free(const SitePort& sites, std::int64_t unit, MapTable table, std::uint32_t words, std::uint32_t align) {
    auto list = sites.site()->site.map();
    std::ranges::sort(list, {}, &Mapping::address);
    std::uint32_t at = 0;
    for (const auto& m : list) {
        if (m.unit != unit || m.table != table) continue;
        if (m.address >= at + words) break;
        if (m.end() > at) at = (m.end() + align - 1) / align * align;
    }
    return at + words > 65536 ? std::nullopt : std::optional(at);
}
Response none_free(std::int64_t unit, std::int64_t words) {
    return problem(409, "conflict", fmt::format("unit {} has no {} free places in a row", unit, words));
}
}  // namespace

Handled get_next_free(Call& c, const SitePort& sites) {
    std::optional<Response> fault;
    const auto unit = query_whole(c, "unit", 2, 254, 2, fault);
    const auto words = query_whole(c, "words", 1, 1024, 1, fault);
    // A whole block of an axis begins where the standard map would have one.
    const auto align = query_whole(c, "align", 1, 1024, words == registers_per_axis ? registers_per_axis : 1, fault);
    if (fault) return *fault;
    const auto table = table_named(c.target.query.get("table").value_or("holding_registers"));
    if (!table) return bad_query("table", "holding_registers, input_registers, coils or discrete_inputs");
    const auto at = next_free(sites, unit, *table, static_cast<std::uint32_t>(words), static_cast<std::uint32_t>(align));
    return at ? json_response(json::object{{"address", *at}}) : none_free(unit, words);
}

Handled add_mapping_template(Call& c, SitePort& sites, const StagePort& staging) {
    std::vector<Fault> faults;
    const auto& body = c.body.get_object();
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
    const auto* name = body.if_contains("template");
    if (!name || *name != json::value("standard_map"))
        faults.push_back({"/template", "template must be standard_map", "write \"standard_map\""});
    const auto* axis = body.if_contains("axis");
    if (!axis || !axis->is_string()) faults.push_back({"/axis", "axis must be the name of an axis", "write its name"});
    const auto unit = whole("unit", 2, 254);
    const bool anywhere = !body.contains("address");
    auto address = anywhere ? 0 : whole("address", 0, 65'535 - 48);
    const auto* dry = body.if_contains("dry_run");
    if (dry && !dry->is_bool()) faults.push_back({"/dry_run", "dry_run must be true or false", "write true or false"});
    if (!faults.empty()) return invalid(std::move(faults));
    if (anywhere) {
        const auto at = next_free(sites, unit, MapTable::holding_registers, registers_per_axis, registers_per_axis);
        if (!at) return none_free(unit, registers_per_axis);
        address = *at;
    }
    json::array entries;
    for (const auto& s : standard_points()) {
        const auto point = axis_point_named(s.point);
        if (!point) continue;
        entries.push_back(json::object{{"unit", unit},
                                       {"table", "holding_registers"},
                                       {"address", address + s.offset},
                                       {"axis", axis->get_string()},
                                       {"point", s.point},
                                       {"type", name_of(s.type)},
                                       {"word_order", name_of(standard_order(c))},
                                       {"access", s.writable ? name_of(MapAccess::read_write) : name_of(MapAccess::read)}});
    }
    auto plan = [&sites, entries](const SiteState& before) -> Planned {
        json::object document = to_json(before.site);
        auto& list = document["mappings"].get_array();
        const auto had = list.size();
        for (const auto& e : entries)
            list.push_back(e);
        std::vector<SiteFault> wrong;
        auto site = parse_site(document, sites.families(), wrong);
        if (!site) return refusal_for(wrong, "", false);
        json::array added(site->mappings.begin() + static_cast<std::ptrdiff_t>(had), site->mappings.end());
        return Plan{std::move(*site), [added](const std::shared_ptr<const SiteState>& now) {
                        Response r = json_response(json::object{{"dry_run", false}, {"mappings", added}}, 201);
                        put_revision(r, *now);
                        return r;
                    }};
    };
    if (!dry || !dry->get_bool()) return change_site(c, sites, staging, false, std::move(plan));
    const auto now = sites.site();
    if (auto refusal = precondition(c, sites, *now, false)) return *std::move(refusal);
    auto planned = plan(*now);
    if (auto* refusal = std::get_if<Response>(&planned)) return std::move(*refusal);
    const auto& all = std::get<Plan>(planned).site.mappings;
    return json_response(
        json::object{{"dry_run", true}, {"mappings", json::array(all.end() - static_cast<std::ptrdiff_t>(entries.size()), all.end())}});
}

}  // namespace axisgate::http
