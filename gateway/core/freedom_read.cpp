// Reads "freedoms" of a family's page.
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/specimen.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

std::int64_t whole(const json::object& o, std::string_view key, const std::string& where, std::vector<std::string>& faults) {
    const auto* v = o.if_contains(key);
    if (v && v->is_int64()) return v->get_int64();
    faults.push_back(fmt::format("{}.{}: a whole number is missing", where, key));
    return 0;
}

std::string text(const json::object& o, std::string_view key, const std::string& where, std::vector<std::string>& faults) {
    const auto* v = o.if_contains(key);
    if (v && v->is_string() && !v->get_string().empty()) return std::string(v->get_string());
    faults.push_back(fmt::format("{}.{}: a text is missing", where, key));
    return {};
}

bool permits(const Freedom& f, std::int64_t value) {
    if (value < f.min || value > f.max) return false;
    return f.values.empty() || std::ranges::any_of(f.values, [&](const auto& v) { return v.first == value; });
}

Freedom freedom_from(const json::object& o, const std::string& where, std::vector<std::string>& faults) {
    Freedom f;
    f.name = text(o, "name", where, faults);
    f.description = text(o, "description", where, faults);
    f.source = text(o, "source", where, faults);
    if (const auto* unit = o.if_contains("unit"); unit && unit->is_string()) f.unit = std::string(unit->get_string());
    f.min = whole(o, "min", where, faults);
    f.max = whole(o, "max", where, faults);
    f.fallback = whole(o, "default", where, faults);
    if (const auto* values = o.if_contains("values"); values && values->is_object()) {
        for (const auto& [key, meaning] : values->get_object()) {
            std::int64_t n = 0;
            const std::string_view digits = key;
            const auto [end, wrong] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
            if (wrong != std::errc{} || end != digits.data() + digits.size() || !meaning.is_string())
                faults.push_back(fmt::format("{}.values: {} is not a whole number with a text", where, digits));
            else
                f.values.emplace_back(n, std::string(meaning.get_string()));
        }
    }
    if (f.min > f.max || !permits(f, f.fallback)) faults.push_back(fmt::format("{}: min, max, values and default disagree", where));
    const auto* named = o.if_contains("named");
    for (const auto& [name, value] : named && named->is_object() ? named->get_object() : json::object()) {
        const bool known = std::ranges::find(named_specimens, std::string_view(name)) != named_specimens.end();
        if (!known || !value.is_int64() || !permits(f, value.get_int64()))
            faults.push_back(fmt::format("{}.named.{}: not a named specimen with a permitted value", where, std::string_view(name)));
        else
            f.extremes.emplace(std::string(name), value.get_int64());
    }
    return f;
}
}  // namespace

std::vector<Freedom> read_freedoms(const json::object& page, std::vector<std::string>& faults) {
    std::vector<Freedom> out;
    const auto* list = page.if_contains("freedoms");
    if (!list) return out;
    if (!list->is_array()) {
        faults.push_back("catalogue.freedoms: not a list");
        return out;
    }
    std::set<std::string, std::less<>> names;
    for (const auto& v : list->get_array()) {
        const std::string where = fmt::format("freedoms[{}]", out.size());
        if (!v.is_object()) {
            faults.push_back(where + ": not an object");
            continue;
        }
        out.push_back(freedom_from(v.get_object(), where, faults));
        if (!names.insert(out.back().name).second) faults.push_back(fmt::format("{}: {} is there twice", where, out.back().name));
    }
    return out;
}

}  // namespace axisgate
