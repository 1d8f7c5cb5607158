// Half of the freedoms of a drawn specimen keep the manual's value, because a drive that differs in everything hides which difference
// mattered. The others are drawn evenly on a logarithmic scale: 3 ms and 300 ms are equally interesting. The scale begins at 0 and goes in
// both directions if the range has 0, otherwise it begins at the lower bound.
#include "gateway/core/specimen.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace axisgate {
namespace {

std::optional<std::uint32_t> seed_of(std::string_view text) noexcept {
    std::uint32_t n = 0;
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (text.empty() || wrong != std::errc{} || end != text.data() + text.size() || n > largest_specimen) return std::nullopt;
    return n;
}

double fraction(std::uint64_t draw) noexcept { return static_cast<double>(draw >> 11) * 0x1p-53; }

std::int64_t drawn(const Freedom& f, std::uint32_t seed) {
    if (specimen_draw(seed, f.name, 0) % 2 == 0) return f.fallback;
    const std::uint64_t draw = specimen_draw(seed, f.name, 1);
    if (!f.values.empty()) return f.values[draw % f.values.size()].first;
    const std::int64_t origin = f.min <= 0 && f.max >= 0 ? 0 : f.min;
    const double below = std::log1p(static_cast<double>(origin) - static_cast<double>(f.min));
    const double above = std::log1p(static_cast<double>(f.max) - static_cast<double>(origin));
    const double place = fraction(draw) * (below + above) - below;
    const double away = std::copysign(std::exp(std::abs(place)) - 1, place);
    return std::clamp(origin + static_cast<std::int64_t>(std::llround(away)), f.min, f.max);
}

const Freedom* find(const Catalogue& page, std::string_view name) {
    const auto it = std::ranges::find(page.freedoms(), name, &Freedom::name);
    return it == page.freedoms().end() ? nullptr : &*it;
}

std::string permitted(const Freedom& f) {
    if (f.values.empty()) return fmt::format("a whole number from {} to {}{}{}", f.min, f.max, f.unit.empty() ? "" : " ", f.unit);
    std::string list;
    for (const auto& [n, meaning] : f.values)
        list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", n, meaning);
    return "one of " + list;
}

/// Empty if the freedom does not permit the text.
std::optional<std::int64_t> value_of(const Freedom& f, std::string_view text) {
    std::int64_t n = 0;
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (text.empty() || wrong != std::errc{} || end != text.data() + text.size() || n < f.min || n > f.max) return std::nullopt;
    if (!f.values.empty() && std::ranges::none_of(f.values, [&](const auto& v) { return v.first == n; })) return std::nullopt;
    return n;
}
}  // namespace

std::uint64_t specimen_draw(std::uint64_t seed, std::string_view place, std::uint64_t count) noexcept {
    return specimen_draw_at(specimen_place(seed, place), count);
}

bool is_specimen(std::string_view text) noexcept {
    return std::ranges::find(named_specimens, text) != named_specimens.end() || seed_of(text).has_value();
}

std::string check_specimen(std::string_view text) {
    if (is_specimen(text)) return {};
    std::string names;
    for (const auto name : named_specimens)
        names += fmt::format(", {}", name);
    return fmt::format("specimen = {}: write a seed from 0 (the drive as its manual shows it) to {}{}", text, largest_specimen, names);
}

FreedomValues specimen_values(const Catalogue& page, std::string_view specimen) {
    FreedomValues out;
    const auto seed = seed_of(specimen);
    for (const Freedom& f : page.freedoms()) {
        const auto extreme = f.extremes.find(specimen);
        out[f.name] = seed && *seed != 0 ? drawn(f, *seed) : extreme != f.extremes.end() ? extreme->second : f.fallback;
    }
    return out;
}

FreedomValues freedoms_of(const Catalogue& page, const std::map<std::string, std::string>& options) {
    const auto specimen = options.find("specimen");
    FreedomValues out = specimen_values(page, specimen == options.end() ? "0" : std::string_view(specimen->second));
    for (const Freedom& f : page.freedoms()) {
        const auto given = options.find(f.name);
        if (given == options.end()) continue;
        if (const auto value = value_of(f, given->second)) out[f.name] = *value;
    }
    return out;
}

std::string check_freedom(const Catalogue& page, std::string_view name, std::string_view value) {
    const Freedom* f = find(page, name);
    if (!f) return fmt::format("{} is no freedom of {}", name, page.family());
    return value_of(*f, value) ? std::string() : fmt::format("{} = {}: write {}", name, value, permitted(*f));
}

std::vector<std::string> specimen_in_words(const Catalogue& page, const FreedomValues& values) {
    std::vector<std::string> out;
    for (const Freedom& f : page.freedoms()) {
        const std::int64_t value = freedom(values, f.name, f.fallback);
        if (value == f.fallback) continue;
        const auto meaning = std::ranges::find(f.values, value, [](const auto& v) { return v.first; });
        if (meaning != f.values.end())
            out.push_back(fmt::format("{} = {} ({})", f.name, value, meaning->second));
        else
            out.push_back(fmt::format("{} = {}{}{}: {}", f.name, value, f.unit.empty() ? "" : " ", f.unit, f.description));
    }
    return out;
}

}  // namespace axisgate
