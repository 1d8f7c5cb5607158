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
    const Duration grid = std::max<Duration>(std::chrono::milliseconds(1), most / 16);
    // Older instants than the longest lateness are not shown any more.
    Instant at = now - most - grid;
    if (!notes_.empty()) at = std::max(at, notes_.back().at);
    at = time_zero + (at - time_zero) / grid * grid + grid;
    for (; at <= now; at += grid) {
        drive.advance(at);
        notes_.push_back({at, words_of(drive)});
    }
    while (notes_.size() > 1 && notes_[1].at <= now - most)
        notes_.pop_front();
    drive.advance(now);
}

Words ShownWords::before(const Drive& drive, Instant now, Duration late) const {
    if (late == Duration::zero() || notes_.empty()) return words_of(drive);
    const auto later = std::ranges::upper_bound(notes_, now - late, {}, &Note::at);
    return later == notes_.begin() ? later->words : std::prev(later)->words;
}

Words ShownWords::at(const Drive& drive, Instant now) const {
    Words shown = before(drive, now, manners_.status_late);
    if (longest() == manners_.status_late) return shown;
    const auto status_of = [&](Duration late) { return before(drive, now, manners_.status_late + late).status; };
    const bool in_target = (status_of(manners_.in_target_late) & 0x0400u) != 0, moves = (status_of(manners_.motion_late) & 0x2000u) != 0;
    shown.warn = before(drive, now, manners_.status_late + manners_.warn_late).warn;
    take_bit(shown.status, 0x0400u, in_target);
    take_bit(shown.status, 0x2000u, moves);
    take_bit(shown.status, 0x0080u, shown.warn != 0);
    return shown;
}

}  // namespace axisgate::linmot::twin
