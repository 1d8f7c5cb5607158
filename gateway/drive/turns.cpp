// A drive is in a ring at most once. An entry whose wish has changed meanwhile is skipped.
#include "gateway/drive/turns.hpp"

#include <algorithm>

namespace axisgate::drive {

void Turns::set(const TurnRules& rules) noexcept {
    rules_ = rules;
    rules_.window = std::clamp<std::size_t>(rules.window, 1, slot_limit);
    rules_.probe_window = std::clamp<std::size_t>(rules.probe_window, 1, rules_.window);
    overtaken_.set(rules.overtaken_limit, rules.overtaken_grace);
}

void Turns::forget_wishes() noexcept {
    for (Ring& r : ring_)
        r.clear();
    want_.fill(Want::nothing);
    in_ring_.fill(0);
}

void Turns::line_changed(Instant now) noexcept {
    forget_wishes();
    heap_.clear();
    place_.fill(Place::none);
    overtaken_.clear();
    in_flight_ = probes_in_flight_ = 0;
    quiet_until_ = now_ = now;
}

void Turns::remove(std::size_t slot) noexcept {
    ended(slot);
    want_[slot] = Want::nothing;
    heap_.set(slot, never);
}

void Turns::settle(std::size_t slot, Want want, Instant deadline, Instant wish) noexcept {
    constexpr std::array<RingOf, 6> ring_of{rings, urgents, commands, quicks, polls, probes};
    want_[slot] = want;
    if (const RingOf r = ring_of[static_cast<std::size_t>(want)]; r != rings) {
        const auto bit = static_cast<std::uint8_t>(1u << r);
        if (!(in_ring_[slot] & bit)) {
            in_ring_[slot] |= bit;
            ring_[r].push(slot);
        }
    }
    // A drive that waits for a place, or has one, is not called for its wish.
    const bool may_wish = want == Want::nothing && place_[slot] == Place::none;
    heap_.set(slot, may_wish ? std::min(deadline, wish) : deadline);
}

/// Commands and polls of one drive take each other's places: the drive sends what it needs next.
bool Turns::right(RingOf ring, Want want) noexcept {
    switch (ring) {
        case urgents:
            return want == Want::urgent;
        case probes:
            return want == Want::probe;
        default:
            return want == Want::command || want == Want::quick_poll || want == Want::poll;
    }
}

std::optional<Turns::RingOf> Turns::choose(Instant now) noexcept {
    if (waits(urgents)) return urgents;
    const bool poll_waits = waits(quicks) || waits(polls);
    if (waits(commands) && !((poll_waits || may_probe()) && commands_run_ >= commands_in_a_row)) return commands;
    if (may_probe() && !(probed_last_ && poll_waits)) return probes;
    if (poll_waits && (rules_.overtaken_limit == 0 || overtaken_.may_begin(now)))
        return waits(quicks) && !(waits(polls) && quick_run_ >= quick_in_a_row) ? quicks : polls;
    return waits(commands) ? std::optional(commands) : std::nullopt;
}

std::optional<std::size_t> Turns::next(Instant now) noexcept {
    now_ = now;
    while (in_flight_ < rules_.window && now >= quiet_until_) {
        const auto ring = choose(now);
        if (!ring) return std::nullopt;
        const std::size_t slot = ring_[*ring].pop();
        in_ring_[slot] &= static_cast<std::uint8_t>(~(1u << *ring));
        if (!right(*ring, want_[slot])) continue;
        if (*ring == commands) {
            commands_run_ = std::min(commands_run_ + 1, commands_in_a_row);
        } else if (*ring != urgents) {
            commands_run_ = 0;
            probed_last_ = *ring == probes;
            quick_run_ = *ring == quicks ? quick_run_ + 1 : 0;
        }
        want_[slot] = Want::nothing;
        return slot;
    }
    return std::nullopt;
}

std::optional<std::size_t> Turns::due(Instant now) const noexcept {
    return heap_.earliest() <= now ? std::optional(heap_.first()) : std::nullopt;
}

Instant Turns::deadline() const noexcept {
    Instant d = heap_.earliest();
    const bool poll_waits = waits(quicks) || waits(polls);
    if ((!poll_waits && !waits(urgents) && !waits(commands) && !waits(probes)) || in_flight_ >= rules_.window) return d;
    // Waiting exchanges wait for the end of the pause after an answer, or of the grace time of overtaken exchanges; otherwise only a
    // received frame or a time-out frees a place.
    if (quiet_until_ > now_) d = std::min(d, quiet_until_);
    if (poll_waits && rules_.overtaken_limit != 0 && overtaken_.deadline() > now_) d = std::min(d, overtaken_.deadline());
    return d;
}

void Turns::began(std::size_t slot, bool probe) noexcept {
    if (place_[slot] != Place::none) return;
    place_[slot] = probe ? Place::probe : Place::ordinary;
    ++in_flight_;
    if (probe) ++probes_in_flight_;
    overtaken_.began(slot);
}

void Turns::ended(std::size_t slot) noexcept {
    if (place_[slot] == Place::none) return;
    --in_flight_;
    if (place_[slot] == Place::probe) --probes_in_flight_;
    place_[slot] = Place::none;
    overtaken_.ended(slot);
}

}  // namespace axisgate::drive
