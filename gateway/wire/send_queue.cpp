// SendQueue: see send_queue.hpp. Slots in one vector, chained into one list per priority and one of free slots.
// In and out: frames. Never moves a waiting frame.
#include "gateway/wire/send_queue.hpp"

#include <algorithm>

namespace axisgate {

bool SendQueue::push(const Frame& frame, Priority priority, Instant now) {
    if (size_ >= capacity_ && !make_room(priority)) return false;
    Index i = free_;
    if (i != none) {
        free_ = slots_[i].next;
    } else {
        if (slots_.size() == slots_.capacity()) slots_.reserve(std::min(capacity_, std::max<std::size_t>(4, slots_.size() * 2)));
        i = static_cast<Index>(slots_.size());
        slots_.emplace_back();
    }
    List& list = lists_[static_cast<std::size_t>(priority)];
    Slot& s = slots_[i];
    s.entry.frame = frame;
    s.entry.priority = priority;
    s.entry.queued_at = now;
    s.next = none;
    s.previous = list.tail;
    if (list.tail != none) {
        slots_[list.tail].next = i;
    } else {
        list.head = i;
    }
    list.tail = i;
    ++size_;
    return true;
}

/// A stop must not be refused because polls wait: it costs the youngest of the least urgent frames its place.
bool SendQueue::make_room(Priority priority) noexcept {
    if (priority != Priority::urgent) return false;
    for (const Priority p : {Priority::poll, Priority::command}) {
        const Index victim = lists_[static_cast<std::size_t>(p)].tail;
        if (victim == none) continue;
        unlink(victim);
        ++displaced_;
        return true;
    }
    return false;
}

void SendQueue::unlink(Index i) noexcept {
    Slot& s = slots_[i];
    List& list = lists_[static_cast<std::size_t>(s.entry.priority)];
    (s.previous != none ? slots_[s.previous].next : list.head) = s.next;
    (s.next != none ? slots_[s.next].previous : list.tail) = s.previous;
    s.next = free_;
    free_ = i;
    --size_;
}

SendQueue::Index SendQueue::best(Instant t) const noexcept {
    for (const List& list : lists_) {
        if (list.head != none && slots_[list.head].entry.queued_at <= t) return list.head;
    }
    return none;
}

const SendQueue::Entry* SendQueue::front(Instant t) const noexcept {
    const Index i = best(t);
    return i == none ? nullptr : &slots_[i].entry;
}

void SendQueue::pop(Instant t) noexcept {
    const Index i = best(t);
    if (i != none) unlink(i);
}

std::size_t SendQueue::collect(std::span<const Entry*> to) const noexcept {
    std::size_t n = 0;
    for (const List& list : lists_) {
        for (Index i = list.head; i != none && n < to.size(); i = slots_[i].next)
            to[n++] = &slots_[i].entry;
    }
    return n;
}

Instant SendQueue::earliest() const noexcept {
    Instant t = never;
    for (const List& list : lists_) {
        if (list.head != none) t = std::min(t, slots_[list.head].entry.queued_at);
    }
    return t;
}

std::size_t SendQueue::drop_older_than(Instant t) noexcept {
    std::size_t n = 0;
    for (List& list : lists_) {
        for (; list.head != none && slots_[list.head].entry.queued_at < t; ++n)
            unlink(list.head);
    }
    return n;
}

void SendQueue::clear() noexcept {
    for (List& list : lists_) {
        while (list.head != none)
            unlink(list.head);
    }
}

}  // namespace axisgate
