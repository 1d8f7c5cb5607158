#include "adapters/linmot/twin/shown_words.hpp"

#include <algorithm>

namespace axisgate::linmot::twin {
namespace {
Words words_of(const Drive& drive) { return {drive.status_word(), drive.state_var(), drive.warn_word()}; }
void take_bit(std::uint16_t& word, unsigned bit, bool on) { word = static_cast<std::uint16_t>(on ? word | bit : word & ~bit); }
}  // namespace

Duration ShownWords::longest() const noexcept {
    const Duration further = std::max({manners_.motion_late, manners_.in_target_late, manners_.warn_late});
    return manners_.status_late + further;
}

void ShownWords::advance(Drive& drive, Instant now) {
    const Duration most = longest();
    if (most == Duration::zero()) return drive.advance(now);
    constexpr Duration shortest = std::chrono::milliseconds(1);
    const Duration look = std::max<Duration>(2 * shortest, most / 16);
    Instant at = looked_at_;
    if (notes_.empty() || now - at > most + look) drive.advance(at = now - most - look);  // older words are not shown any more
    while (at < now) {
        if (!noted_) note(words_of(drive), at);
        at = std::min(std::max(drive.words_due(look), at + shortest), now);
        drive.advance(at);
        noted_ = false;
    }
    looked_at_ = now;
    while (notes_.size() > 1 && notes_[1].at <= now - most)
        notes_.pop_front();
}

Words ShownWords::before(Instant now, Duration late) const {
    if (late == Duration::zero()) return notes_.back().words;
    const auto later = std::ranges::upper_bound(notes_, now - late, {}, &Note::at);
    return later == notes_.begin() ? later->words : std::prev(later)->words;
}

void ShownWords::note(const Words& words, Instant at) {
    if (notes_.empty() || !(notes_.back().words == words)) notes_.push_back({at, words});
    noted_ = true;
}

Words ShownWords::at(const Drive& drive, Instant now) {
    if (longest() == Duration::zero()) return words_of(drive);
    note(words_of(drive), now);
    Words shown = before(now, manners_.status_late);
    if (longest() == manners_.status_late) return shown;
    const auto status_of = [&](Duration late) { return before(now, manners_.status_late + late).status; };
    const bool in_target = (status_of(manners_.in_target_late) & 0x0400u) != 0, moves = (status_of(manners_.motion_late) & 0x2000u) != 0;
    shown.warn = before(now, manners_.status_late + manners_.warn_late).warn;
    take_bit(shown.status, 0x0400u, in_target);
    take_bit(shown.status, 0x2000u, moves);
    take_bit(shown.status, 0x0080u, shown.warn != 0);
    return shown;
}

}  // namespace axisgate::linmot::twin
