// Event outlet: one thread's way to the storage for what happened; each thread has its own, so that no event crosses another one.
// In: events with their instant. Out: pushed into that thread's ring. Full: counted; the next one that finds a place tells how many are
// missing. Never waits.
#pragma once

#include <atomic>

#include "gateway/runtime/cold.hpp"

namespace axisgate {

class EventOutlet {
public:
    /// Before the first send(); without a ring events go nowhere.
    void connect(Mailbox<ColdJob>* ring) noexcept { ring_ = ring; }
    /// The one thread that this outlet is of. The caller announces the ring.
    void send(Event event, Instant at);
    /// Any thread: events that found the ring full, since the start.
    [[nodiscard]] std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

private:
    Mailbox<ColdJob>* ring_ = nullptr;
    std::atomic<std::uint64_t> lost_{0};
    std::uint64_t reported_ = 0;
};

}  // namespace axisgate
