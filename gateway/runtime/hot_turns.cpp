// The timer and the sleep of the hot loop, and the measurement of turns without the time of the sleep.
#include "gateway/runtime/hot_turns.hpp"

#include <chrono>

namespace axisgate {

void HotTurns::end(Instant now) noexcept {
    times_.observe(now - began_);
    began_ = now;
}

void HotTurns::count(Instant now) noexcept {
    count_.fetch_add(1, std::memory_order_relaxed);
    live(now);
}

void HotTurns::arm(Instant deadline) {
    if (armed_ <= deadline && armed_ > clock_()) return;
    armed_ = deadline;
    if (deadline == never) {
        timer_.cancel();
        return;
    }
    timer_.expires_at(std::chrono::steady_clock::time_point(
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(deadline.time_since_epoch())));
    timer_.async_wait([this, deadline](const boost::system::error_code& ec) {
        if (ec) return;
        armed_ = never;
        wake_delays_.observe(now() - deadline);
    });
}

/// The handler runs inside the wait, and the turn begins with its first reading of the time. The thread's processor time would be more
/// exact, but costs two system calls for each sleep.
void HotTurns::sleep() {
    asleep_ = true;
    io_.run_one();
    (void)now();
}

}  // namespace axisgate
