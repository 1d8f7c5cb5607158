// When the hot loop wakes, how long its turns take, and how late its timer is. It has one timer for the loop's deadlines, and the
// measurements can be read by any thread.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>

#include "gateway/core/histogram.hpp"
#include "gateway/runtime/clock.hpp"

namespace axisgate {

class HotTurns {
public:
    HotTurns(boost::asio::io_context& io, Instant (*clock)() noexcept) : io_(io), clock_(clock) {}

    // --- the loop's thread ---
    // The time. The first reading after a sleep is the begin of the turn, because every handler begins with one.
    [[nodiscard]] Instant now() const noexcept {
        const Instant t = clock_();
        if (asleep_) {
            asleep_ = false;
            began_ = t;
        }
        return t;
    }
    /// Work begins, or has continued until now without a sleep.
    void begin(Instant now) noexcept { began_ = now; }
    /// The work since then is a turn; the next one begins at once, unless the loop sleeps first.
    void end(Instant now) noexcept;
    /// All work that was ready at this instant has been done.
    void count(Instant now) noexcept;
    /// The loop is alive: `last` counts from here.
    void live(Instant now) noexcept { last_ns_.store(ns_of(now), std::memory_order_relaxed); }
    /// Sets the loop's one timer. An early timer costs only a turn, so it is set anew only when it must be earlier.
    void arm(Instant deadline);
    [[nodiscard]] Instant armed() const noexcept { return armed_; }
    /// Waits for the next handler and runs it.
    void sleep();

    // --- any thread ---
    // Instant of the last turn, for the watchdog.
    [[nodiscard]] Instant last() const noexcept { return at_ns(last_ns_.load(std::memory_order_relaxed)); }
    [[nodiscard]] std::uint64_t counted() const noexcept { return count_.load(std::memory_order_relaxed); }
    /// Work between two sleeps.
    [[nodiscard]] const Histogram& times() const noexcept { return times_; }
    /// Delay of the timer.
    [[nodiscard]] const Histogram& wake_delays() const noexcept { return wake_delays_; }

private:
    boost::asio::io_context& io_;
    Instant (*clock_)() noexcept;
    boost::asio::steady_timer timer_{io_};
    Instant armed_ = never;
    mutable Instant began_{};
    mutable bool asleep_ = false;
    std::atomic<std::int64_t> last_ns_{0};
    std::atomic<std::uint64_t> count_{0};
    Histogram times_, wake_delays_;
};

}  // namespace axisgate
