// The permitted options are those of the catalogue's "options", for a twin also `specimen` and the page's freedoms, and those that the
// gateway itself reads for every line.
#include "gateway/site/options.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "gateway/core/specimen.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

constexpr std::string_view name_of(OptionOf place) noexcept {
    switch (place) {
        case OptionOf::line:
            return "line";
        case OptionOf::drive:
            return "drive";
        case OptionOf::twin:
            return "twin";
    }
    return "";
}

std::string_view text_of(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && v->is_string() ? std::string_view(v->get_string()) : std::string_view();
}

bool belongs(const json::object& o, std::initializer_list<OptionOf> places) {
    const auto* of = o.if_contains("of");
    if (!of || !of->is_array()) return false;
    return std::ranges::any_of(of->get_array(), [&](const json::value& v) {
        return v.is_string() && std::ranges::any_of(places, [&](OptionOf p) { return name_of(p) == std::string_view(v.get_string()); });
    });
}

std::vector<const json::object*> of(const Catalogue& catalogue, std::initializer_list<OptionOf> places) {
    std::vector<const json::object*> out;
    const auto* list = catalogue.document().if_contains("options");
    if (!list || !list->is_array()) return out;
    for (const auto& v : list->get_array()) {
        if (v.is_object() && belongs(v.get_object(), places)) out.push_back(&v.get_object());
    }
    return out;
}

const json::object* find(const Catalogue& catalogue, std::initializer_list<OptionOf> places, std::string_view name) {
    const auto list = of(catalogue, places);
    const auto it = std::ranges::find_if(list, [&](const json::object* o) { return text_of(*o, "name") == name; });
    return it == list.end() ? nullptr : *it;
}

std::string check_value(const json::object& o, std::string_view name, std::string_view value) {
    if (const auto* values = o.if_contains("values"); values && values->is_array()) {
        std::string list;
        for (const auto& v : values->get_array()) {
            if (!v.is_string()) continue;
            if (std::string_view(v.get_string()) == value) return {};
            list += (list.empty() ? "" : ", ") + std::string(v.get_string());
        }
        return fmt::format("{} = {}: write one of {}", name, value, list);
    }
    const auto bound = [&](std::string_view key) -> std::optional<double> {
        const auto* v = o.if_contains(key);
        return v && v->is_int64() ? std::optional(static_cast<double>(v->get_int64())) : std::nullopt;
    };
    const auto low = bound("min"), high = bound("max");
    if (!low || !high) return {};
    std::int64_t n = 0;
    const auto [end, wrong] = std::from_chars(value.data(), value.data() + value.size(), n);
    if (wrong == std::errc{} && end == value.data() + value.size() && static_cast<double>(n) >= *low && static_cast<double>(n) <= *high)
        return {};
    const std::string_view unit = text_of(o, "unit");
    return fmt::format("{} = {}: write a whole number from {:.0f} to {:.0f}{}{}", name, value, *low, *high, unit.empty() ? "" : " ", unit);
}
}  // namespace

std::string check_option(const Catalogue& catalogue, std::initializer_list<OptionOf> places, std::string_view name,
                         std::string_view value) {
    if (const json::object* o = find(catalogue, places, name)) return check_value(*o, name, value);
    if (std::ranges::find(places, OptionOf::twin) != places.end()) {
        if (name == "specimen") return check_specimen(value);
        if (std::ranges::find(catalogue.freedoms(), name, &Freedom::name) != catalogue.freedoms().end())
            return check_freedom(catalogue, name, value);
    }
    std::string known;
    for (const json::object* o : of(catalogue, places))
        known += (known.empty() ? "" : ", ") + std::string(text_of(*o, "name"));
    return fmt::format("{} is no option here; {} has {}", name, catalogue.family(), known.empty() ? "none" : known);
}

std::vector<OptionFault> check_options(const Site& site, const Families& families) {
    std::vector<OptionFault> out;
    for (const LineSpec& l : site.lines) {
        std::vector<const Catalogue*> catalogues;  // of the families on the line
        for (const auto& name : site.families_on(l)) {
            if (const auto* c = families.find(name).catalogue) catalogues.push_back(c);
        }
        for (const auto& given : l.options) {
            const auto& name = given.first;
            const auto& value = given.second;
            // Options of the gateway itself, for every line with twins: a byte line for a family that also has CAN, and separate wires for
            // each direction.
            if (name == "kind" || name == "full_duplex") continue;
            // Each family that has the option must accept its value; if none has it, the first one lists its options.
            const auto named = [&](const Catalogue& c) { return find(c, {OptionOf::line, OptionOf::twin}, name) != nullptr; };
            const bool known = std::ranges::any_of(catalogues, [&](const Catalogue* c) { return named(*c); });
            for (const Catalogue* c : catalogues) {
                if (known && !named(*c)) continue;
                if (auto wrong = check_option(*c, {OptionOf::line, OptionOf::twin}, name, value); !wrong.empty()) {
                    out.push_back(
                        {l.name, "", fmt::format("line {}: option {}", l.name, wrong), find(*c, {OptionOf::line}, name) != nullptr});
                    break;
                }
            }
        }
        for (const DriveSpec& d : site.drives) {
            const auto* catalogue = d.line == l.name ? families.find(site.family_of(d)).catalogue : nullptr;
            if (!catalogue) continue;
            for (const auto& [name, value] : d.options) {
                if (auto wrong = check_option(*catalogue, {OptionOf::drive, OptionOf::twin}, name, value); !wrong.empty()) {
                    out.push_back({l.name, d.name, fmt::format("drive {}: option {}", d.name, wrong),
                                   find(*catalogue, {OptionOf::drive}, name) != nullptr});
                }
            }
        }
    }
    return out;
}

}  // namespace axisgate
