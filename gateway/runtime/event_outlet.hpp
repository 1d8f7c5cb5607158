// The way of one thread's events to the storage; each thread has its own, so that their events need no lock. If the ring is full, events
// are counted, and the next one that finds a place reports the number of missing ones.
#pragma once

#include <atomic>

#include "gateway/runtime/cold.hpp"

namespace axisgate {

class EventOutlet {
public:
    /// Before the first send(); without a ring events are dropped.
    void connect(Mailbox<ColdJob>* ring) noexcept { ring_ = ring; }
    /// Only on the thread of this outlet. The caller announces the ring.
    void send(Event event, Instant at);
    /// Any thread: number of events that found the ring full, since the start.
    [[nodiscard]] std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

private:
    Mailbox<ColdJob>* ring_ = nullptr;
    std::atomic<std::uint64_t> lost_{0};
    std::uint64_t reported_ = 0;
};

}  // namespace axisgate
