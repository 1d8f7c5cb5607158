// The result is a catalogue in JSON, which is read like every catalogue. Units are not derived, because an EDS does not contain any.
#include "adapters/cia402/parameters.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/object.hpp>
#include <boost/json/serialize.hpp>
#include <map>
#include <memory>
#include <set>
#include <vector>

namespace axisgate::cia402_drive {
namespace {
namespace json = boost::json;
using canopen::Address;
using canopen::DataType;
using canopen::EdsEntry;
constexpr std::string_view member = "described_by";
constexpr std::size_t longest_name = 60;

std::string_view catalogue_type(DataType type) {
    switch (type) {
        case DataType::boolean:
            return "bool";
        case DataType::unsigned8:
            return "u8";
        case DataType::integer8:
            return "i8";
        case DataType::unsigned16:
            return "u16";
        case DataType::integer16:
            return "i16";
        case DataType::integer24:
            return "i24";
        case DataType::unsigned32:
            return "u32";
        case DataType::integer32:
            return "i32";
        case DataType::integer64:
        case DataType::unsigned64:
            return "i64";
        case DataType::real32:
            return "f32";
        case DataType::real64:
            return "f64";
        case DataType::visible_string:
            return "text";
        default:
            return "bytes";  // hex pairs, low byte first
    }
}

json::value json_of(const Value& value) {
    if (const auto* b = std::get_if<bool>(&value)) return *b;
    if (const auto* i = std::get_if<std::int64_t>(&value)) return *i;
    if (const auto* d = std::get_if<double>(&value)) return *d;
    if (const auto* s = std::get_if<std::string>(&value)) return json::value(*s);
    return nullptr;
}
/// Values that depend on the node number differ between two drives of one description.
json::value json_of(const canopen::EdsValue& v) { return v.plus_node ? json::value() : json_of(v.value); }

/// SYNC, EMCY, error control, SDO channels and PDOs, store and restore: the gateway writes them when the drive starts, or by a command.
bool is_gateways(std::uint16_t index) {
    const auto in = [index](std::uint16_t from, std::uint16_t through) { return index >= from && index <= through; };
    return in(0x1005, 0x1007) || in(0x1010, 0x1011) || in(0x1014, 0x1017) || in(0x1200, 0x12FF) || in(0x1400, 0x1BFF) || in(0x1F80, 0x1F8F);
}

std::string_view group_of(std::uint16_t index) {
    return index < 0x2000 ? "communication" : index < 0x6000 ? "maker" : index < 0xA000 ? "profile" : "network";
}

/// The object name of a file as a parameter name: "Speed, max." is speed_max.
std::string as_name(std::string_view words) {
    std::string out;
    for (const char c : words) {
        const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        if ((lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9'))
            out += lower;
        else if (!out.empty() && out.back() != '_')
            out += '_';
    }
    if (out.size() > longest_name) out.resize(longest_name);
    while (!out.empty() && out.back() == '_')
        out.pop_back();
    if (out.empty() || (out[0] >= '0' && out[0] <= '9')) out = "object" + (out.empty() ? out : "_" + out);
    return out;
}

std::string id_of(Address a, bool variable) {
    return variable ? fmt::format("{:04X}h", a.index) : fmt::format("{:04X}h:{:02X}", a.index, a.sub);
}

class Overlay {
public:
    Overlay(const canopen::Eds& eds, const DescriptionText& file) : eds_(eds), file_(file) {}

    json::array parameters(const json::array& page) {
        json::array out;
        for (const auto& v : page)
            known(v.as_object(), out);
        for (const auto& v : out) {
            taken_.insert(std::string(v.at("id").as_string()));
            taken_.insert(std::string(v.at("name").as_string()));
        }
        for (const auto& [address, e] : eds_.entries)
            other(address, e, out);
        return out;
    }

    /// The values that a DCF gives to parameters which can be written, in the order of their objects. Those that depend on the node number,
    /// and those that a download of the configuration leaves out (ObjFlags bit 0, CiA 306-1), are not among them.
    [[nodiscard]] json::array configured() const {
        json::array out;
        for (const auto& [address, e] : eds_.entries) {
            const auto id = ids_.find(address);
            if (id == ids_.end() || !e.configured.given() || e.configured.plus_node || (e.flags & 1u) != 0) continue;
            out.push_back(json::object{{"parameter", id->second}, {"value", json_of(e.configured)}});
        }
        return out;
    }

private:
    /// Where the value is read from, and whether it can be read: a write-only entry is left out where only the gateway writes.
    static std::string_view access_of(const EdsEntry& e, bool reads_only) {
        const bool read = canopen::can_read(e.access), write = canopen::can_write(e.access) && !reads_only;
        return read && write ? "RW" : read ? "R" : write ? "W" : "";
    }

    void known(json::object p, json::array& out) {
        const auto* wire = p.at("wire").if_object();
        const auto* index = wire ? wire->if_contains("index") : nullptr;
        const auto* sub = wire ? wire->if_contains("sub") : nullptr;
        if (!index || !sub) return out.push_back(std::move(p));
        const Address at{static_cast<std::uint16_t>(index->as_int64()), static_cast<std::uint8_t>(sub->as_int64())};
        const auto found = eds_.entries.find(at);
        if (found == eds_.entries.end()) return;
        const EdsEntry& e = found->second;
        const std::string_view access = access_of(e, p.at("access") == "R" || is_gateways(at.index));
        covered_.insert(at);
        if (access.empty() || e.type == DataType::domain) return;
        const std::string id(p.at("id").as_string());
        const bool row = p.contains("count") && p.at("count").is_int64();
        const auto* first = p.if_contains("first");
        const std::int64_t start = first && first->is_int64() ? first->as_int64() : 0;
        if (access != "R") ids_[at] = row ? fmt::format("{}[{}]", id, start) : id;
        if (row) {
            int n = 1;
            for (auto next = std::next(found); next != eds_.entries.end() && at.sub + n < 255; ++next, ++n) {
                const Address there{at.index, static_cast<std::uint8_t>(at.sub + n)};
                if (next->first != there || next->second.type != e.type || next->second.access != e.access) break;
                covered_.insert(there);
                if (access != "R") ids_[there] = fmt::format("{}[{}]", id, start + n);
            }
            p["count"] = n;
        }
        if (const auto type = catalogue_type(e.type); p.at("type").as_string() != type) {
            // The bits and enumerated values of the catalogue belong to another type.
            p["type"] = type;
            for (const auto* of_type : {"allowed", "values", "fields", "meanings", "alternate", "min", "max", "default"})
                p.erase(of_type);
            p["allowed"] = nullptr;
        }
        if (p.at("access").as_string() != access) p["storage"] = access == "R" ? "status" : "ram";
        p["access"] = access;
        values(e, p, false);
        p["source"] = source_of(e);
        out.push_back(std::move(p));
    }

    void other(Address at, const EdsEntry& e, json::array& out) {
        if (covered_.contains(at) || e.type == DataType::domain) return;
        const auto object = eds_.objects.find(at.index);
        const bool variable = object == eds_.objects.end() || object->second.shape == canopen::EdsShape::variable;
        if (!variable && at.sub == 0 && !canopen::can_write(e.access)) return;  // number of entries
        const std::string_view access = access_of(e, is_gateways(at.index));
        if (access.empty()) return;
        const std::string words = variable || object == eds_.objects.end() ? e.name : object->second.name + " " + e.name;
        const std::string id = id_of(at, variable);
        std::string name = as_name(words);
        if (taken_.contains(name)) name = as_name(fmt::format("{} {:04x} {:02x}", name.substr(0, longest_name - 8), at.index, at.sub));
        if (!taken_.insert(name).second || !taken_.insert(id).second) return;  // a catalogue row has the same name, and takes precedence
        const bool writable = access != "R";
        if (writable) ids_[at] = id;
        const bool at_once =
            writable && (e.access == canopen::EntryAccess::write_only || e.access == canopen::EntryAccess::read_write_output || e.mappable);
        json::object p{{"id", id},
                       {"name", name},
                       {"group", group_of(at.index)},
                       {"type", catalogue_type(e.type)},
                       {"unit", nullptr},
                       {"min", nullptr},
                       {"max", nullptr},
                       {"default", nullptr},
                       {"access", access},
                       {"storage", writable ? "ram" : "status"},
                       {"allowed", nullptr},
                       {"description", fmt::format("{}: {} ({}{}).{}", file_.name, words.empty() ? id : words, canopen::name_of(e.type),
                                                   e.mappable ? ", PDO" : "", is_gateways(at.index) ? " The gateway sets it." : "")},
                       {"source", source_of(e)},
                       {"wire", json::object{{"index", at.index}, {"sub", at.sub}}}};
        if (at_once) p["live"] = true;
        values(e, p, true);
        out.push_back(std::move(p));
    }

    /// Limits and default of the file, completed by those of the catalogue. `all`: the catalogue has no such row.
    void values(const EdsEntry& e, json::object& p, bool all) const {
        const bool number = catalogue_type(e.type) != "bytes" && catalogue_type(e.type) != "text" && e.type != DataType::boolean;
        const auto put = [&](const char* key, const canopen::EdsValue& v, bool fits) {
            const json::value given = fits ? json_of(v) : json::value();
            if (!given.is_null() || all || !p.contains(key)) p[key] = given;
        };
        put("min", e.low, number);
        put("max", e.high, number);
        put("default", e.fallback, true);
        const auto end = [&](const char* key) {
            const auto* v = p.if_contains(key);
            return v && v->is_number() ? std::optional(v->to_number<double>()) : std::nullopt;
        };
        // One limit of the catalogue and one of the file can contradict each other; then only the file counts.
        if (const auto low = end("min"), high = end("max"); low && high && *low > *high) p[e.low.given() ? "max" : "min"] = nullptr;
    }

    [[nodiscard]] std::string source_of(const EdsEntry& e) const {
        return e.line == 0 ? file_.name : fmt::format("{}, line {}", file_.name, e.line);
    }

    const canopen::Eds& eds_;
    const DescriptionText& file_;
    std::set<Address> covered_;
    std::map<Address, std::string> ids_;  ///< of parameters that can be written
    std::set<std::string> taken_;
};

/// Any bytes as a JSON text and back: each byte is the character with its number.
std::string letters_of(std::string_view bytes) {
    std::string out;
    out.reserve(bytes.size());
    for (const char c : bytes) {
        const auto b = static_cast<unsigned char>(c);
        if (b < 0x80) {
            out += c;
        } else {
            out += static_cast<char>(0xC0 | b >> 6);
            out += static_cast<char>(0x80 | (b & 0x3F));
        }
    }
    return out;
}
std::string bytes_of_letters(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto b = static_cast<unsigned char>(text[i]);
        out +=
            b < 0x80 || i + 1 == text.size() ? text[i] : static_cast<char>((b & 3) << 6 | (static_cast<unsigned char>(text[++i]) & 0x3F));
    }
    return out;
}

json::value number_or_nothing(const std::optional<std::uint32_t>& n) { return n ? json::value(*n) : json::value(); }

/// Modes that both the catalogue and the file have; those of the catalogue if the file has no list.
json::array modes_of(const Catalogue& page, const canopen::Eds& eds) {
    const auto supported = eds.entries.find({0x6502, 0});
    const auto bits = supported == eds.entries.end() ? std::nullopt : as_integer(supported->second.fallback.value);
    json::array both, all;
    for (const std::int16_t m : page.modes()) {
        all.emplace_back(m);
        if (bits && m >= 1 && m <= 32 && (*bits >> (m - 1) & 1)) both.emplace_back(m);
    }
    return both.empty() ? all : both;
}
}  // namespace

OwnCatalogue own_catalogue(const CatalogueWish& wish) {
    if (wish.description == nullptr) return {};
    std::vector<canopen::FileFault> faults, notes;
    const auto eds = canopen::read_eds(wish.description->text, faults, notes);
    if (!eds)
        return {nullptr, fmt::format("description {}, line {}: {}", wish.description->name, faults.empty() ? 0 : faults.front().line,
                                     faults.empty() ? std::string("it cannot be read") : faults.front().text)};
    json::object document = wish.page.document();
    Overlay overlay(*eds, *wish.description);
    document["parameters"] = overlay.parameters(wish.page.document().at("parameters").as_array());
    if (json::array values = overlay.configured(); !values.empty()) document["configured"] = std::move(values);
    document["modes"] = modes_of(wish.page, *eds);
    document[member] = json::object{{"name", wish.description->name},
                                    {"vendor_number", number_or_nothing(eds->vendor_number)},
                                    {"product_number", number_or_nothing(eds->product_number)},
                                    {"revision_number", number_or_nothing(eds->revision_number)},
                                    {"text", letters_of(wish.description->text)}};
    std::vector<std::string> wrong;
    auto made = Catalogue::parse(json::serialize(document), wrong);
    if (!made) return {nullptr, fmt::format("description {}: {}", wish.description->name, wrong.front())};
    return {std::make_shared<const Catalogue>(std::move(*made)), {}};
}

std::optional<canopen::Eds> description_of(const Catalogue& catalogue) {
    const auto* d = catalogue.document().if_contains(member);
    if (!d) return std::nullopt;
    std::vector<canopen::FileFault> faults, notes;
    return canopen::read_eds(bytes_of_letters(d->at("text").as_string()), faults, notes);
}

ExpectedIdentity expected_identity(const Catalogue& catalogue) {
    ExpectedIdentity out;
    const auto* d = catalogue.document().if_contains(member);
    if (!d) return out;
    out.description = std::string(d->at("name").as_string());
    std::size_t i = 0;
    for (const char* key : {"vendor_number", "product_number", "revision_number"}) {
        const auto* v = d->as_object().if_contains(key);
        if (v && v->is_number()) out.numbers[i] = v->to_number<std::uint32_t>();
        ++i;
    }
    return out;
}

std::string differs(const ExpectedIdentity& expected, const Identity& drive) {
    static constexpr std::array<std::string_view, 3> names{"vendor", "product", "revision"};
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto &want = expected.numbers[i], &has = drive[i];
        if (!want || !has || *want == 0) continue;
        const int unimportant = i == 2 ? 16 : 0;
        if (*want >> unimportant == *has >> unimportant) continue;
        out += fmt::format("{}{} {:X}h, not {:X}h", out.empty() ? "" : ", ", names[i], *has, *want);
    }
    if (out.empty()) return {};
    return fmt::format("the drive is another one than description {} says: {}. Name the right description, or exchange the drive",
                       expected.description, out);
}

}  // namespace axisgate::cia402_drive
