// A specimen is one drive of a family: a value for each freedom of the family's page. It is named by a seed, from which the values are
// drawn, or by a name of an extreme. Seed 0 is the drive as its manual shows it. The value of a freedom depends on the seed and on the
// name of the freedom alone, so a page that gets a further freedom does not change the others.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/freedom.hpp"

namespace axisgate {

/// The names of the extremes: late in everything; without optional parts; insists on every rule; sends more than was asked; little force,
/// much play; an early firmware.
inline constexpr std::array<std::string_view, 6> named_specimens{"slow", "sparse", "strict", "chatty", "weak", "old"};
inline constexpr std::uint32_t largest_specimen = 1'000'000'000;

/// "0" to "1000000000", or one of the names.
[[nodiscard]] bool is_specimen(std::string_view text) noexcept;
/// Empty if `text` names a specimen, otherwise the fault and the remedy.
[[nodiscard]] std::string check_specimen(std::string_view text);

/// The value of every freedom in this specimen. A text that is no specimen has the defaults.
[[nodiscard]] FreedomValues specimen_values(const Catalogue& page, std::string_view specimen);
/// As above with options["specimen"], where an option that is named like a freedom has precedence. Options that cannot be used are ignored.
[[nodiscard]] FreedomValues freedoms_of(const Catalogue& page, const std::map<std::string, std::string>& options);
/// Empty if the page has a freedom of this name that permits the value, otherwise the fault and the remedy.
[[nodiscard]] std::string check_freedom(const Catalogue& page, std::string_view name, std::string_view value);

/// The specimen in words, one line for each freedom that differs from the manual's drive; empty for specimen 0.
[[nodiscard]] std::vector<std::string> specimen_in_words(const Catalogue& page, const FreedomValues& values);

/// The finalizer of SplitMix64.
[[nodiscard]] constexpr std::uint64_t specimen_mixed(std::uint64_t x) noexcept {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31);
}
/// The part of `specimen_draw` that does not depend on the count, for a place at which numbers are drawn often.
[[nodiscard]] constexpr std::uint64_t specimen_place(std::uint64_t seed, std::string_view place) noexcept {
    std::uint64_t h = specimen_mixed(seed);
    for (const char c : place)
        h = specimen_mixed(h ^ static_cast<unsigned char>(c));
    return h;
}
[[nodiscard]] constexpr std::uint64_t specimen_draw_at(std::uint64_t place, std::uint64_t count) noexcept {
    return specimen_mixed(place ^ count);
}
/// A number for a place and a count, evenly distributed: the pseudo-random source of specimens and of their behaviour in time.
[[nodiscard]] std::uint64_t specimen_draw(std::uint64_t seed, std::string_view place, std::uint64_t count = 0) noexcept;

}  // namespace axisgate
