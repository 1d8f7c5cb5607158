// SYNC turns: plans the shortest round in which all nodes fit, and assigns the places of targets.
// No beat has more than its share, except for a node that is alone in a beat which cannot be longer.
#include "gateway/protocols/canopen/sync_turns.hpp"

#include <algorithm>

#include "gateway/core/wire_time.hpp"

namespace axisgate::canopen {
namespace {
using std::chrono::milliseconds;

std::uint64_t bits_in(Duration time, std::uint32_t bit_rate) {
    const std::uint64_t rate = bit_rate == 0 ? 1'000'000 : bit_rate;
    return static_cast<std::uint64_t>(time.count() / 1000) * rate / 1'000'000;
}

/// Slots for all nodes with at most `axes` in a beat, each in the emptiest one; empty if they do not fit.
std::vector<int> slots_of(const TurnsWish& wish, int turns, int axes, bool keep) {
    std::vector<int> used(static_cast<std::size_t>(turns), 0), slots(wish.nodes.size(), 0);
    const auto put = [&](std::size_t node, int slot) {
        slots[node] = slot;
        return (used[static_cast<std::size_t>(slot)] += wish.nodes[node].axes) <= axes;
    };
    const auto stays = [&](const TurnsWish::Node& n) { return keep && n.slot >= 0 && n.slot < turns; };
    for (std::size_t i = 0; i < slots.size(); ++i)
        if (stays(wish.nodes[i]) && !put(i, wish.nodes[i].slot)) return {};
    for (std::size_t i = 0; i < slots.size(); ++i)
        if (!stays(wish.nodes[i]) && !put(i, static_cast<int>(std::ranges::min_element(used) - used.begin()))) return {};
    return slots;
}
}  // namespace

std::uint64_t pdo_share(Duration time, std::uint32_t bit_rate) noexcept { return bits_in(time, bit_rate) / 2; }

SyncTurns plan_turns(const TurnsWish& wish) {
    SyncTurns plan;
    int all = 0, largest = 0;
    for (const auto& n : wish.nodes) {
        all += n.axes;
        largest = std::max(largest, n.axes);
    }
    const auto sync = most_bits(0);
    const auto targets = [&](int n) { return static_cast<std::uint64_t>(n) * wish.target_bits; };
    const auto room = [&](Duration beat) {  // for this many axes
        const auto share = pdo_share(beat, wish.bit_rate);
        const std::uint64_t pdos = share > sync ? share - sync : 0;
        const std::uint64_t kept = std::max({targets(1), targets(wish.places), std::min(targets(4), pdos / 4)});
        return pdos > kept ? static_cast<int>(std::min<std::uint64_t>((pdos - kept) / std::max(1u, wish.axis_bits), 1024)) : 0;
    };
    plan.beat = std::max<Duration>(wish.beat, milliseconds(1));
    while (plan.beat < std::chrono::seconds(10) && (room(plan.beat) < std::max(1, largest) || room(plan.beat) * most_turns < 2 * all))
        plan.beat += milliseconds(1);

    const int most = std::max(room(plan.beat), std::max(1, largest));
    for (plan.turns = std::max(1, (all + most - 1) / most); plan.turns < most_turns; ++plan.turns)
        if (!slots_of(wish, plan.turns, most, false).empty() || wish.nodes.empty()) break;
    for (plan.axes = std::max(largest, (all + plan.turns - 1) / plan.turns);; ++plan.axes) {
        plan.slots = slots_of(wish, plan.turns, plan.axes, true);
        if (plan.slots.empty()) plan.slots = slots_of(wish, plan.turns, plan.axes, false);
        if (!plan.slots.empty() || wish.nodes.empty()) break;
    }
    plan.bits = sync + static_cast<std::uint64_t>(plan.axes) * wish.axis_bits;
    const auto share = pdo_share(plan.beat, wish.bit_rate);
    const auto left = share > plan.bits ? (share - plan.bits) / std::max(1u, wish.target_bits) : 0;
    plan.places = static_cast<int>(std::clamp<std::uint64_t>(left, 1, 1024));
    return plan;
}

std::optional<TargetTurns::Place> TargetTurns::take(int places, int others, int longest) {
    int free = 0;
    for (const int used : used_)
        free += std::max(0, places - used);
    for (int turns = 1; turns <= longest; turns *= 2) {
        if (turns < longest && free - most / turns < others * (most / longest)) continue;
        Place best{turns, 0};
        int least = places;
        for (int phase = 0; phase < turns; ++phase) {
            int fullest = 0;
            for (int beat = phase; beat < most; beat += turns)
                fullest = std::max(fullest, used_[static_cast<std::size_t>(beat)]);
            if (fullest >= least) continue;
            least = fullest;
            best.phase = phase;
        }
        if (least >= places) continue;
        for (int beat = best.phase; beat < most; beat += turns)
            ++used_[static_cast<std::size_t>(beat)];
        return best;
    }
    return std::nullopt;
}

void TargetTurns::give_back(const Place& place) noexcept {
    for (int beat = place.phase; beat < most; beat += place.turns)
        --used_[static_cast<std::size_t>(beat)];
}
int TargetTurns::fullest() const noexcept { return *std::ranges::max_element(used_); }

int longest_turns(int axes, int places) noexcept {
    int turns = 2;
    while (turns < TargetTurns::most && turns * places < 2 * axes)
        turns *= 2;
    return turns;
}

}  // namespace axisgate::canopen
