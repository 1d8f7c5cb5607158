// A value of the standard map is named by its axis and point, one of a user map by its mapping.
#include "gateway/services/site/register_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "gateway/core/text.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
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

/// The unit of a mapping's point, before scale and offset; empty: none.
std::string unit_of_value(const Mapping& m, const SiteState& site, const SitePort& sites) {
    const auto* axis = site.site.axis(m.axis);
    if (const auto* point = std::get_if<AxisPoint>(&m.what))
        return std::string(unit_of(*point, axis ? std::string_view(axis->unit) : std::string_view()));
    const auto place = find_axis(sites, m.axis);
    const auto* p = place && place->catalogue ? place->catalogue->parameter(std::get<Point>(m.what)) : nullptr;
    return p ? p->unit : std::string();
}

using registers::is_standard_unit, registers::registers_per_axis;

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

std::optional<MapTable> map_table_named(std::string_view name) {
    for (const auto t : {MapTable::coils, MapTable::discrete_inputs, MapTable::holding_registers, MapTable::input_registers}) {
        if (name == name_of(t)) return t;
    }
    return std::nullopt;
}

std::span<const registers::RegisterRow> standard_points() {
    const auto rows = registers::standard_registers();
    return rows.first(static_cast<std::size_t>(std::ranges::find(rows, std::string_view(), &registers::RegisterRow::point) - rows.begin()));
}

std::string mapping_revision_text(const Site& site) { return fmt::format("{:08x}", mapping_revision(site)); }

json::object register_document(const SiteState& site, const RegisterRange& range, const registers::RegisterRead& read,
                               MapWordOrder standard_order) {
    const bool bits = is_bits(range.table);
    json::object o{{"unit", range.unit},      {"table", name_of(range.table)},          {"address", range.address},
                   {"count", range.count},    {bits ? "bits" : "words", json::array()}, {"exception", json::value()},
                   {"decoded", json::array()}};
    if (read.verdict != registers::Verdict::good) {
        const auto code = static_cast<unsigned>(read.verdict);
        o["exception"] = json::object{{"code", code}, {"text", exception_text(code)}};
        return o;
    }
    const auto& data = read.bytes;
    json::array list;
    for (std::uint32_t i = 0; i < range.count; ++i) {
        if (bits)
            list.emplace_back((data[i / 8] >> (i % 8) & 1) != 0);
        else
            list.emplace_back(data[2 * i] << 8 | data[2 * i + 1]);
    }
    o[bits ? "bits" : "words"] = std::move(list);
    o["decoded"] = decoded(site, range.unit, range.table, range.address, range.count, data, standard_order);
    return o;
}

std::vector<ListedMapping> listed_mappings(const SitePort& sites, const SiteState& site) {
    auto list = site.site.map();
    std::ranges::sort(list, [](const Mapping& a, const Mapping& b) {
        return std::tuple(a.unit, a.table, a.address) < std::tuple(b.unit, b.table, b.address);
    });
    std::vector<ListedMapping> rows;
    for (auto& m : list) {
        std::string unit = unit_of_value(m, site, sites);
        rows.push_back({std::move(m), std::move(unit)});
    }
    return rows;
}

}  // namespace axisgate
