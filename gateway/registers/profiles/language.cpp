// Reads a page strictly, because a wrong page would move a machine by a wrong register. Missing members are not filled in, except for
// numbers without a meaning.
#include "gateway/registers/profiles/language.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/json_read.hpp"

namespace axisgate::registers {
namespace {
namespace json = boost::json;

const json::value* member(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && !v->is_null() ? v : nullptr;
}
std::string text_of(const json::object& o, std::string_view key) {
    const auto* v = member(o, key);
    return v && v->is_string() ? std::string(v->get_string()) : std::string();
}
std::optional<double> number_of(const json::object& o, std::string_view key) {
    const auto* v = member(o, key);
    return v && v->is_number() ? std::optional(v->to_number<double>()) : std::nullopt;
}
std::optional<MapType> register_type(std::string_view name) {
    for (const auto t : {MapType::u16, MapType::i16, MapType::u32, MapType::i32, MapType::f32}) {
        if (name_of(t) == name) return t;
    }
    return std::nullopt;
}

std::string read_row(const json::value& v, LanguageRow& row) {
    if (!v.is_object()) return "is no object";
    const auto& o = v.get_object();
    for (const auto& [k, x] : o) {
        constexpr std::array known{"table", "address", "type",    "access", "name",      "meaning",    "axis",
                                   "min",   "max",     "initial", "class",  "attribute", "description"};
        if (std::ranges::find(known, std::string_view(k)) == known.end())
            return fmt::format("has the unknown member {}", std::string_view(k));
    }
    const auto address = number_of(o, "address");
    const auto type = register_type(text_of(o, "type"));
    const std::string table = text_of(o, "table"), access = text_of(o, "access");
    if (!address || *address < 0 || *address > 65535) return "has no address";
    if (!type) return "has no type that registers have";
    if (table != "holding" && table != "input" && table != "both") return "is in no table";
    if (access != "R" && access != "W" && access != "RW") return "has no access";
    row.address = static_cast<std::uint16_t>(*address);
    row.type = *type;
    row.holding = table != "input";
    row.input = table != "holding";
    row.readable = access != "W";
    row.writable = access != "R";
    row.name = text_of(o, "name");
    row.meaning = text_of(o, "meaning");
    row.description = text_of(o, "description");
    row.axis = static_cast<std::uint8_t>(number_of(o, "axis").value_or(0));
    row.min = number_of(o, "min");
    row.max = number_of(o, "max");
    row.initial = number_of(o, "initial").value_or(0);
    if (const auto c = number_of(o, "class"), a = number_of(o, "attribute"); c && a)
        row.object = ObjectPlace{static_cast<std::uint16_t>(*c), static_cast<std::uint16_t>(*a)};
    return row.name.empty() || row.meaning.empty() ? "has no name or no meaning" : "";
}

std::string overlap(const std::vector<LanguageRow>& rows) {
    for (const bool holding : {true, false}) {
        std::uint32_t end = 0;
        for (const auto& r : rows) {
            if (!(holding ? r.holding : r.input)) continue;
            if (r.address < end) return fmt::format("{} stands where another register does", r.name);
            end = r.end();
        }
    }
    return {};
}
}  // namespace

int Language::error_of(std::string_view what) const {
    const auto it = errors.find(std::string(what));
    if (it != errors.end()) return it->second;
    const auto other = errors.find("internal");
    return other == errors.end() ? 1 : other->second;
}

std::shared_ptr<const Language> read_language(std::string_view text, std::string& fault) {
    JsonFault bad;
    const auto document = read_json(text, bad);
    const auto* o = document ? document->if_object() : nullptr;
    const auto* rows = o ? member(*o, "registers") : nullptr;
    if (!rows || !rows->is_array()) {
        fault = document ? "registers are missing" : bad.text;
        return nullptr;
    }
    auto l = std::make_shared<Language>();
    l->name = text_of(*o, "language");
    l->title = text_of(*o, "title");
    l->description = text_of(*o, "description");
    l->source = text_of(*o, "source");
    l->word_order = text_of(*o, "word_order") == "low_first" ? MapWordOrder::low_first : MapWordOrder::high_first;
    if (const auto* errors = member(*o, "errors"); errors && errors->is_object()) {
        for (const auto& [k, v] : errors->get_object())
            if (v.is_int64()) l->errors.emplace(k, static_cast<int>(v.get_int64()));
    }
    for (const auto& v : rows->get_array()) {
        LanguageRow row;
        if (const std::string wrong = read_row(v, row); !wrong.empty()) {
            fault = fmt::format("register {} ({}) {}", l->rows.size(), row.name, wrong);
            return nullptr;
        }
        l->rows.push_back(std::move(row));
    }
    std::ranges::stable_sort(l->rows, [](const LanguageRow& a, const LanguageRow& b) {
        return a.address != b.address ? a.address < b.address : a.holding > b.holding;
    });
    fault = overlap(l->rows);
    return fault.empty() ? l : nullptr;
}

}  // namespace axisgate::registers
