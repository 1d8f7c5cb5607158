// The slots are in one vector, linked into one list per priority and sender, and one of free slots. A waiting frame is never moved.
#include "gateway/wire/send_queue.hpp"

#include <algorithm>

namespace axisgate {

bool SendQueue::push(const Frame& frame, Priority priority, Instant now) {
    const std::size_t sender = sender_of(frame);
    senders_ = std::max(senders_, sender + 1);
    if (size_ >= capacity_ && !make_room(priority, sender)) return false;
    Index i = free_;
    if (i != none) {
        free_ = slots_[i].next;
    } else {
        if (slots_.size() == slots_.capacity()) slots_.reserve(std::min(capacity_, std::max<std::size_t>(4, slots_.size() * 2)));
        i = static_cast<Index>(slots_.size());
        slots_.emplace_back();
    }
    List& list = lists_[static_cast<std::size_t>(priority)][sender];
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
    ++of_priority_[static_cast<std::size_t>(priority)];
    ++waiting_[sender];
    return true;
}

std::size_t SendQueue::sender_of(const Frame& frame) noexcept { return std::min<std::size_t>(frame.sender, most_senders - 1); }

/// A stop must not be refused because polls wait, nor the frame of one sender because another sender has filled the queue.
bool SendQueue::make_room(Priority priority, std::size_t sender) noexcept {
    const std::size_t most = static_cast<std::size_t>(std::ranges::max_element(waiting_) - waiting_.begin());
    if (most != sender && waiting_[sender] < capacity_ / senders_ && push_out(most)) return true;
    if (priority != Priority::urgent) return false;
    if (push_out(sender)) return true;
    for (std::size_t other = 0; other < senders_; ++other) {
        if (push_out(other)) return true;
    }
    return false;
}

/// Removes the youngest of a sender's least urgent frames, but none of its stops.
bool SendQueue::push_out(std::size_t sender) noexcept {
    for (const Priority p : {Priority::poll, Priority::command}) {
        const Index victim = lists_[static_cast<std::size_t>(p)][sender].tail;
        if (victim == none) continue;
        unlink(victim);
        ++displaced_;
        return true;
    }
    return false;
}

void SendQueue::unlink(Index i) noexcept {
    Slot& s = slots_[i];
    const std::size_t sender = sender_of(s.entry.frame);
    List& list = lists_[static_cast<std::size_t>(s.entry.priority)][sender];
    (s.previous != none ? slots_[s.previous].next : list.head) = s.next;
    (s.next != none ? slots_[s.next].previous : list.tail) = s.previous;
    s.next = free_;
    free_ = i;
    --size_;
    --of_priority_[static_cast<std::size_t>(s.entry.priority)];
    --waiting_[sender];
}

SendQueue::Index SendQueue::best(Instant t) const noexcept {
    if (size_ == 0) return none;
    for (std::size_t p = 0; p < priorities; ++p) {
        if (of_priority_[p] == 0) continue;
        for (std::size_t k = 0; k < senders_; ++k) {
            const List& list = lists_[p][in_turn(p, k)];
            if (list.head != none && slots_[list.head].entry.queued_at <= t) return list.head;
        }
    }
    return none;
}

const SendQueue::Entry* SendQueue::front(Instant t) const noexcept {
    const Index i = best(t);
    return i == none ? nullptr : &slots_[i].entry;
}

void SendQueue::pop(Instant t) noexcept {
    if (const Index i = best(t); i != none) remove(i);
}

void SendQueue::take(Frame& to, Instant t) noexcept {
    const Index i = best(t);
    to = slots_[i].entry.frame;
    remove(i);
}

/// Removes a frame that has had its turn.
void SendQueue::remove(Index i) noexcept {
    const Entry& e = slots_[i].entry;
    const std::size_t next = sender_of(e.frame) + 1;
    turn_[static_cast<std::size_t>(e.priority)] = static_cast<std::uint32_t>(next < senders_ ? next : 0);
    unlink(i);
}

std::size_t SendQueue::collect(std::span<const Entry*> to) const noexcept {
    std::size_t n = 0;
    for (std::size_t p = 0; p < priorities; ++p) {
        std::array<Index, most_senders> at{};
        for (std::size_t k = 0; k < senders_; ++k)
            at[k] = lists_[p][in_turn(p, k)].head;
        for (bool more = true; more && n < to.size();) {
            more = false;
            for (std::size_t k = 0; k < senders_ && n < to.size(); ++k) {
                if (at[k] == none) continue;
                to[n++] = &slots_[at[k]].entry;
                at[k] = slots_[at[k]].next;
                more = true;
            }
        }
    }
    return n;
}

Instant SendQueue::earliest() const noexcept {
    Instant t = never;
    if (size_ == 0) return t;
    for (std::size_t p = 0; p < priorities; ++p) {
        if (of_priority_[p] == 0) continue;
        for (const List& list : std::span(lists_[p]).first(senders_)) {
            if (list.head != none) t = std::min(t, slots_[list.head].entry.queued_at);
        }
    }
    return t;
}

std::size_t SendQueue::drop_older_than(Instant t) noexcept {
    std::size_t n = 0;
    for (auto& by_sender : lists_) {
        for (List& list : by_sender) {
            for (; list.head != none && slots_[list.head].entry.queued_at < t; ++n)
                unlink(list.head);
        }
    }
    return n;
}

void SendQueue::clear() noexcept { (void)drop_older_than(never); }

}  // namespace axisgate
