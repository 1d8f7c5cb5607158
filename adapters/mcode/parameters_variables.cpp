// Variables, read and worded. A name is one letter, or a letter and a letter or digit [L6022], in upper case from here on.
// In: texts. Out: parameters, names, lines. Never takes a word of the language for a name, but PW, which only one product has [L4970].
#include "adapters/mcode/parameters_variables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/object.hpp>
#include <memory>
#include <sstream>

#include "gateway/core/text.hpp"

namespace axisgate::mcode {
namespace {
namespace json = boost::json;

std::string without_blanks(std::string_view s, bool upper) {
    std::string out;
    for (const char c : s)
        if (c != ' ' && c != '\r' && c != '\t') out += upper && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    return out;
}

bool is_name(std::string_view s, const Language& language) {
    const auto letter = [](char c) { return c >= 'A' && c <= 'Z'; };
    const bool form = !s.empty() && s.size() <= 2 && letter(s[0]) && (s.size() == 1 || letter(s[1]) || (s[1] >= '0' && s[1] <= '9'));
    return form && (!language.find(s) || s == "PW");
}

json::object parameter_for(const std::string& name, std::string_view unit) {
    std::string lower = "uv_";
    for (const char c : name)
        lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return {{"id", std::string(variable_prefix) + name},
            {"name", lower},
            {"group", "register"},
            {"type", "i32"},
            {"unit", unit.empty() ? json::value(nullptr) : json::value(unit)},
            {"min", nullptr},
            {"max", nullptr},
            {"default", nullptr},
            {"access", "RW"},
            {"storage", "saved"},
            {"live", true},
            {"allowed", nullptr},
            {"description",
             fmt::format("User variable {0} of this drive, as the site's option variables names it. Declared in the drive by VA {0}, alone "
                         "or in its program; kept by program.save.",
                         name)},
            {"source", "L543"},
            {"wire", json::object{{"word", name}, {"form", "value"}, {"variable", true}}}};
}

struct Row {
    std::string name, value;
    bool local = false;
};
Row row_of(std::string_view text) {
    Row r;
    const auto equals = text.find('=');
    r.name = without_blanks(text.substr(0, equals), true);
    if (equals != std::string_view::npos) r.value = without_blanks(text.substr(equals + 1), false);
    r.local = r.value.starts_with('L');
    if (r.local || r.value.starts_with('G')) r.value.erase(0, 1);
    return r;
}
template <class Take>
void each_row(std::string_view listing, Take take) {
    std::istringstream in{std::string(listing)};
    for (std::string text; std::getline(in, text);) {
        const Row r = row_of(text);
        if (!r.name.empty() && r.name.size() <= 2 && !r.value.empty()) take(r);
    }
}
}  // namespace

OwnCatalogue own_catalogue(const CatalogueWish& wish) {
    const auto option = wish.options.find("variables");
    if (option == wish.options.end() || without_blanks(option->second, false).empty()) return {};
    const Language language(wish.page);
    const auto wrong = [&](std::string why) { return OwnCatalogue{nullptr, fmt::format("option variables: {}", why)}; };
    json::array more;
    std::vector<std::string> seen;
    std::istringstream in(option->second + ",");
    for (std::string part; std::getline(in, part, ',');) {
        const auto colon = part.find(':');
        const std::string name = without_blanks(part.substr(0, colon), true);
        std::string unit = colon == std::string::npos ? std::string() : without_blanks(part.substr(colon + 1), false);
        if (!is_name(name, language))
            return wrong(
                fmt::format("{} is no user variable: write names of one or two letters and digits that are no words of MCode, with a comma "
                            "between them",
                            name.empty() ? "nothing" : name));
        if (colon != std::string::npos && (unit.empty() || unit.size() > 16))
            return wrong(fmt::format("{}: write its unit behind the colon, up to 16 characters", name));
        if (std::ranges::find(seen, name) != seen.end()) return wrong(fmt::format("{} is there twice", name));
        if (seen.size() == most_variables) return wrong(fmt::format("a drive has at most {}", most_variables));
        more.push_back(parameter_for(name, unit));
        seen.push_back(name);
    }
    std::vector<std::string> faults;
    auto made = wish.page.with(more, faults);
    if (!made) return wrong(faults.front());
    return {std::make_shared<const Catalogue>(std::move(*made)), {}};
}

std::vector<std::string> global_variables(std::string_view listing) {
    std::vector<std::string> names;
    each_row(listing, [&](const Row& r) {
        if (!r.local) names.push_back(r.name);
    });
    return names;
}

std::vector<std::string> listed_variables(std::string_view listing) {
    std::vector<std::string> names;
    each_row(listing, [&](const Row& r) { names.push_back(r.name); });
    return names;
}

std::string variable_line(std::string_view text, const Language& language, std::string& fault) {
    const Row r = row_of(text);
    if (!is_name(r.name, language)) {
        fault = fmt::format("{} is no user variable: write NAME=VALUE, a name of one or two letters and digits",
                            r.name.empty() ? "nothing" : r.name);
        return {};
    }
    const auto v = parse_whole(r.value, INT32_MIN, INT32_MAX);
    if (!v) {
        fault = fmt::format("{}: {} is no whole number from -2147483648 to 2147483647", r.name, r.value.empty() ? "nothing" : r.value);
        return {};
    }
    return r.local ? std::string() : fmt::format("{}={}", r.name, *v);
}

}  // namespace axisgate::mcode
