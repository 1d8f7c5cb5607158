// One pass over all connections and a table of their holders, made only when a door is nearly full. Work of a holder is not protected
// beyond an eighth of all places.
#include "gateway/core/places.hpp"

#include <algorithm>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace axisgate {
namespace {
constexpr std::size_t most_share = 8;   // beyond an eighth of all places a holder's work is not protected
constexpr std::size_t least_share = 8;  // but this number always is

bool is_stranger(Standing s) noexcept { return s == Standing::stranger || s == Standing::strangers_work; }
bool works(Standing s) noexcept { return s == Standing::strangers_work || s == Standing::knowns_work; }
}  // namespace

PlaceHolder place_holder(const std::array<std::uint8_t, 16>& address) noexcept {
    constexpr std::array<std::uint8_t, 12> mapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};
    const bool v4 = std::equal(mapped.begin(), mapped.end(), address.begin());
    PlaceHolder holder = v4 ? 0xFFFF : 0;  // no network of IPv6 in use begins with 0::ffff
    for (std::size_t i = v4 ? 12 : 0; i < (v4 ? 16u : 8u); ++i)
        holder = holder << 8 | address[i];
    return holder;
}

PlaceVerdict find_place(std::span<const Guest> guests, PlaceHolder newcomer, bool known, const PlaceRules& rules, bool full) {
    const std::size_t places = rules.strangers + rules.kept;
    const auto strangers = static_cast<std::size_t>(std::ranges::count_if(guests, is_stranger, &Guest::standing));
    full = full || guests.size() >= places;
    if (!full && (known || strangers < rules.strangers)) return {true, std::nullopt};

    std::unordered_map<PlaceHolder, std::size_t> count;
    std::unordered_map<PlaceHolder, std::vector<Instant>> paths;
    for (const Guest& g : guests) {
        ++count[g.holder];
        if (g.standing == Standing::stop_path) paths[g.holder].push_back(g.since);
    }
    ++count[newcomer];                                     // the new connection counts for its holder
    std::unordered_map<PlaceHolder, Instant> oldest_path;  // of those that are never closed
    for (auto& [holder, list] : paths) {
        const std::size_t last = std::min(rules.paths, list.size());
        if (last == 0) continue;
        std::ranges::nth_element(list, list.begin() + static_cast<std::ptrdiff_t>(last - 1), std::ranges::greater{});
        oldest_path[holder] = list[last - 1];
    }
    using Rank = std::tuple<bool, std::size_t, Instant>;  // known, number of its holder's connections, since when
    std::optional<std::size_t> best;
    Rank best_rank;
    for (std::size_t i = 0; i < guests.size(); ++i) {
        const Guest& g = guests[i];
        const std::size_t held = count[g.holder];
        if (works(g.standing) && held <= std::max(places / most_share, least_share)) continue;
        if (g.standing == Standing::stop_path) {
            const auto kept = oldest_path.find(g.holder);
            if (kept != oldest_path.end() && g.since >= kept->second) continue;
        }
        // If a client without credentials finds all places of such clients taken, only one of these connections is closed.
        if (!full && !is_stranger(g.standing)) continue;
        const Rank rank{!is_stranger(g.standing), places + 1 - std::min(held, places + 1), g.since};
        if (best && !(rank < best_rank)) continue;
        best = i;
        best_rank = rank;
    }
    return {best.has_value(), best};
}

}  // namespace axisgate
