// Used places form a list by age, free ones a stack; a ticket consists of place and generation. Opening and closing never search; only
// forget() walks the list.
#include "gateway/registers/ticket_table.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::registers {

TicketTable::TicketTable(std::size_t capacity) : entries_(std::min<std::size_t>(capacity, none)) {
    for (std::size_t i = entries_.size(); i-- > 0;) {
        entries_[i].younger = free_;
        free_ = static_cast<std::uint16_t>(i);
    }
}

Ticket TicketTable::open(const Waiting& waiting, Instant deadline) {
    const std::uint16_t index = free_;
    Entry& e = entries_[index];
    free_ = e.younger;
    ++e.generation;
    e.waiting = waiting;
    e.deadline = deadline;
    std::uint16_t before = youngest_;
    while (before != none && entries_[before].deadline > deadline)
        before = entries_[before].older;
    e.older = before;
    e.younger = before == none ? oldest_ : entries_[before].younger;
    (before == none ? oldest_ : entries_[before].younger) = index;
    (e.younger == none ? youngest_ : entries_[e.younger].older) = index;
    ++used_;
    return make_ticket(number_, (e.generation << 16) | index);
}

std::optional<TicketTable::Waiting> TicketTable::close(Ticket ticket) {
    const auto index = static_cast<std::uint16_t>(ticket);
    if (index >= entries_.size()) return std::nullopt;
    const Entry& e = entries_[index];
    if ((e.generation & 1u) == 0 || make_ticket(number_, (e.generation << 16) | index) != ticket) return std::nullopt;
    return take(index);
}

std::optional<TicketTable::Waiting> TicketTable::expired(Instant now) {
    if (oldest_ == none || entries_[oldest_].deadline > now) return std::nullopt;
    return take(oldest_);
}

TicketTable::Waiting TicketTable::take(std::uint16_t index) {
    Entry& e = entries_[index];
    (e.older == none ? oldest_ : entries_[e.older].younger) = e.younger;
    (e.younger == none ? youngest_ : entries_[e.younger].older) = e.older;
    ++e.generation;
    e.younger = free_;
    e.older = none;
    free_ = index;
    --used_;
    return std::exchange(e.waiting, {});
}

void TicketTable::forget(const WriteOwner* owner) noexcept {
    for (std::uint16_t i = oldest_; i != none; i = entries_[i].younger) {
        if (entries_[i].waiting.owner == owner) entries_[i].waiting.owner = nullptr;
    }
}

void TicketTable::forget(const UnitMap* map) noexcept {
    for (std::uint16_t i = oldest_; i != none; i = entries_[i].younger) {
        if (entries_[i].waiting.map == map) entries_[i].waiting.map = nullptr;
    }
}

}  // namespace axisgate::registers
