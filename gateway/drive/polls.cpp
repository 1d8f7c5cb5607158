#include "gateway/drive/polls.hpp"

#include <algorithm>

namespace axisgate::drive {

void PollTimer::asked(Instant now, Duration period) noexcept {
    const Instant rhythm = next_ == never ? never : next_ + period;
    next_ = rhythm > now && rhythm < now + period ? rhythm : now + period;
}

Polls::Entry* Polls::find(Item item) noexcept {
    const auto it = std::ranges::find(entries_, item, &Entry::item);
    return it == entries_.end() ? nullptr : &*it;
}

bool Polls::every(Item item, Duration period, Instant first) {
    if (Entry* e = find(item)) {
        e->period = period;
        if (first < e->timer.deadline()) e->timer.soon(first);
        return true;
    }
    if (entries_.size() >= limit) return false;
    Entry& e = entries_.emplace_back();
    e.item = item;
    e.period = period;
    e.timer.soon(first);
    return true;
}

bool Polls::soon(Item item, Instant now) {
    if (!find(item) && !every(item, {}, now)) return false;
    Entry& e = *find(item);
    e.first = true;
    e.timer.soon(now);
    return true;
}

void Polls::quick(Item item, bool on) noexcept {
    if (Entry* e = find(item)) e->quick = on;
}

void Polls::drop(Item item) noexcept {
    std::erase_if(entries_, [item](const Entry& e) { return e.item == item; });
}

void Polls::clear() noexcept { entries_.clear(); }

std::optional<Polls::Item> Polls::next(Instant now) {
    Entry* best = nullptr;
    Entry* slow = nullptr;  // the best of the items that are neither first nor quick
    const auto before = [](const Entry& a, const Entry& b) {
        if (a.timer.deadline() != b.timer.deadline()) return a.timer.deadline() < b.timer.deadline();
        return a.asked < b.asked;
    };
    const auto rank = [](const Entry& e) { return e.first ? 0 : e.quick ? 1 : 2; };
    for (Entry& e : entries_) {
        if (!e.timer.due(now)) continue;
        if (!best || rank(e) < rank(*best) || (rank(e) == rank(*best) && before(e, *best))) best = &e;
        if (rank(e) == 2 && (!slow || before(e, *slow))) slow = &e;
    }
    if (!best) return std::nullopt;
    const bool ahead = rank(*best) < 2;
    if (ahead && slow && quick_run_ >= quick_in_a_row) best = slow;
    quick_run_ = ahead && best != slow && slow ? quick_run_ + 1 : 0;
    const Item item = best->item;
    if (best->period <= Duration::zero()) {
        drop(item);
        return item;
    }
    best->first = false;
    best->asked = ++count_;
    best->timer.asked(now, best->period);
    return item;
}

Instant Polls::deadline() const noexcept {
    Instant d = never;
    for (const Entry& e : entries_)
        d = std::min(d, e.timer.deadline());
    return d;
}

}  // namespace axisgate::drive
