// Shows the content of an EDS, and writes a snapshot as a DCF. Values that a file does not contain are null.
#include "gateway/services/descriptions/description.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "gateway/core/text.hpp"
#include "gateway/protocols/canopen/pdo.hpp"

namespace axisgate::descriptions {
namespace json = boost::json;
using canopen::Address;
using canopen::Eds;
using canopen::EdsEntry;

std::string check_name(std::string_view name) {
    const bool form =
        name.size() <= 64 && std::ranges::all_of(name, [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
        });
    if (form && name.size() > 4 && name[0] != '.' && (name.ends_with(".eds") || name.ends_with(".dcf"))) return {};
    return "the name of a description has up to 64 letters, digits, - _ . and ends with .eds or .dcf";
}

Read read(std::string_view text) {
    Read r;
    if (text.size() > most_bytes) {
        r.faults.push_back({0, fmt::format("the file has {} bytes; at most {} are kept", text.size(), most_bytes)});
        return r;
    }
    auto eds = canopen::read_eds(text, r.faults, r.notes);
    if (!eds) {
        if (r.faults.empty()) r.faults.push_back({0, "this is no EDS or DCF file"});
        return r;
    }
    if (eds->entries.size() > most_entries)
        r.faults.push_back({0, fmt::format("the file has {} entries; at most {} are kept", eds->entries.size(), most_entries)});
    const auto type = eds->entries.find({0x1000, 0});
    const auto profile = type == eds->entries.end() ? std::nullopt : as_integer(type->second.fallback.value);
    if (profile && (*profile & 0xFFFF) != 402)
        r.faults.push_back({type->second.line, fmt::format("1000h says device profile {}: a drive has 402", *profile & 0xFFFF)});
    for (const std::uint16_t needed : {std::uint16_t{0x6040}, std::uint16_t{0x6041}}) {
        if (!eds->entries.contains({needed, 0}))
            r.faults.push_back({0, fmt::format("{:04X}h is missing: a drive of CiA 402 has it", needed)});
    }
    if (r.faults.empty()) r.eds = std::move(eds);
    return r;
}

std::vector<Fault> faults_of(const Read& read) {
    std::vector<Fault> out;
    for (const auto& f : read.faults)
        out.push_back({"", f.line == 0 ? f.text : fmt::format("line {}: {}", f.line, f.text),
                       "mend the file, or ask its maker for one that CiA 306 allows", true});
    return out;
}

namespace {
json::value number_or_null(const std::optional<std::uint32_t>& n) { return n ? json::value(*n) : json::value(); }

/// DeviceComissioning of a DCF.
json::value commissioning_of(const Eds& eds) {
    if (!eds.commissioning) return nullptr;
    const auto& c = *eds.commissioning;
    return json::object{{"node", c.node == 0 ? json::value() : json::value(c.node)},
                        {"node_name", text_or_null(c.node_name)},
                        {"bit_rate_kbit", c.kbit == 0 ? json::value() : json::value(c.kbit)}};
}

std::optional<std::int64_t> configured(const Eds& eds, Address a) {
    const auto it = eds.entries.find(a);
    if (it == eds.entries.end()) return std::nullopt;
    const auto& e = it->second;
    return as_integer((e.configured.given() ? e.configured : e.fallback).value);
}

/// PDOs as the file has them mapped by default.
json::array pdos(const Eds& eds) {
    json::array out;
    for (const bool receive : {true, false}) {
        const std::uint16_t base = receive ? 0x1600 : 0x1A00;
        for (std::uint16_t n = 0; n < 512; ++n) {
            const auto index = static_cast<std::uint16_t>(base + n);
            if (!eds.objects.contains(index)) continue;
            json::array mapped;
            const auto count = std::clamp<std::int64_t>(configured(eds, {index, 0}).value_or(0), 0, 64);
            for (std::uint8_t sub = 1; sub <= count; ++sub) {
                const auto word = configured(eds, {index, sub});
                if (!word || *word == 0) continue;
                const Address at{static_cast<std::uint16_t>(*word >> 16 & 0xFFFF), static_cast<std::uint8_t>(*word >> 8 & 0xFF)};
                const auto object = eds.entries.find(at);
                mapped.push_back(json::object{{"object", at.sub == 0 ? fmt::format("{:04X}h", at.index) : canopen::to_text(at)},
                                              {"name", object == eds.entries.end() ? json::value() : json::value(object->second.name)},
                                              {"bits", *word & 0xFF}});
            }
            out.push_back(json::object{{"direction", receive ? "receive" : "transmit"}, {"number", n + 1}, {"mapped", std::move(mapped)}});
        }
    }
    return out;
}
}  // namespace

std::shared_ptr<const json::object> facts(const Description& d, const Read& read) {
    if (!read.eds) return nullptr;
    const Eds& eds = *read.eds;
    json::array kbits, warnings;
    for (const auto k : eds.kbits)
        kbits.emplace_back(k);
    for (const auto& n : read.notes)
        warnings.push_back(json::object{{"line", n.line}, {"text", n.text}});
    return std::make_shared<const json::object>(json::object{{"name", d.name},
                                                             {"bytes", d.text.size()},
                                                             {"added_at", format_time(d.at_unix_ns)},
                                                             {"added_by", text_or_null(d.who)},
                                                             {"vendor", text_or_null(eds.vendor)},
                                                             {"vendor_number", number_or_null(eds.vendor_number)},
                                                             {"product", text_or_null(eds.product)},
                                                             {"product_number", number_or_null(eds.product_number)},
                                                             {"revision_number", number_or_null(eds.revision_number)},
                                                             {"order_code", text_or_null(eds.order_code)},
                                                             {"bit_rates_kbit", std::move(kbits)},
                                                             {"objects", eds.objects.size()},
                                                             {"entries", eds.entries.size()},
                                                             {"commissioning", commissioning_of(eds)},
                                                             {"pdos", pdos(eds)},
                                                             {"warnings", std::move(warnings)}});
}

json::array objects_of(const Read& read) {
    json::array out;
    if (!read.eds) return out;
    const auto shown = [](const canopen::EdsValue& v) -> json::value {
        if (!v.given()) return nullptr;
        const std::string text = to_text(v.value);
        return v.plus_node ? json::value("$NODEID + " + text) : json::value(text);
    };
    for (const auto& [at, e] : read.eds->entries) {
        const auto object = read.eds->objects.find(at.index);
        const bool alone = object == read.eds->objects.end() || object->second.shape == canopen::EdsShape::variable ||
                           object->second.shape == canopen::EdsShape::domain;
        out.push_back(json::object{{"object", alone ? fmt::format("{:04X}h", at.index) : canopen::to_text(at)},
                                   {"of", alone ? json::value() : text_or_null(object->second.name)},
                                   {"name", text_or_null(e.name)},
                                   {"type", canopen::name_of(e.type)},
                                   {"access", canopen::name_of(e.access)},
                                   {"mappable", e.mappable},
                                   {"low", shown(e.low)},
                                   {"high", shown(e.high)},
                                   {"default", shown(e.fallback)},
                                   {"configured", shown(e.configured)},
                                   {"line", e.line == 0 ? json::value() : json::value(e.line)}});
    }
    return out;
}

Dcf dcf_of(const Eds& eds, const Catalogue& catalogue, const AxisSnapshot& snapshot, std::uint8_t node, std::string_view node_name,
           std::uint32_t bit_rate) {
    Dcf out;
    std::map<Address, Value> values;
    for (const auto& v : snapshot.parameters) {
        const auto point = catalogue.find(v.parameter);
        const Parameter* p = point ? catalogue.parameter(*point) : nullptr;
        const auto* index = p ? p->wire.if_contains("index") : nullptr;
        const auto* sub = p ? p->wire.if_contains("sub") : nullptr;
        if (!index || !sub || !index->is_int64() || !sub->is_int64()) {
            out.left_out.push_back(v.parameter + " is no object of the description");
            continue;
        }
        const auto element = p->count == 0 ? 0 : point->element - p->first;
        const Address at{static_cast<std::uint16_t>(index->get_int64()), static_cast<std::uint8_t>(sub->get_int64() + element)};
        // A DCF is used to set up a drive, so read-only objects are left out.
        const auto e = eds.entries.find(at);
        if (e != eds.entries.end() && !canopen::can_write(e->second.access)) continue;
        values[at] = v.value;
    }
    canopen::Commissioning c;
    c.node = node;
    c.node_name = std::string(node_name);
    c.kbit = bit_rate / 1000;
    const std::chrono::sys_time<std::chrono::minutes> at{
        std::chrono::floor<std::chrono::minutes>(std::chrono::nanoseconds(snapshot.at_unix_ns))};
    const auto day = std::chrono::floor<std::chrono::days>(at);
    const std::chrono::year_month_day date{day};
    const auto minutes = (at - day).count();
    const canopen::DcfDate made{fmt::format("{:02}:{:02}{}", (minutes / 60 + 11) % 12 + 1, minutes % 60, minutes < 12 * 60 ? "AM" : "PM"),
                                fmt::format("{:02}-{:02}-{:04}", static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                                            static_cast<int>(date.year()))};
    out.text = canopen::write_dcf(eds, c, values, made, out.left_out);
    return out;
}

}  // namespace axisgate::descriptions
