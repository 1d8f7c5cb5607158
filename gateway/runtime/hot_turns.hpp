// HotTurns: when the hot loop wakes, how long its turns take, how late its timer rings.
// In: the loop's deadlines, beginnings and ends of turns. Out: one timer that rings in time, what others read of the turns.
// Never decides what a turn does.
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
    /// The time. The first look at it after a sleep is where the turn begins: all that a handler does begins with one.
    [[nodiscard]] Instant now() const noexcept {
        const Instant t = clock_();
        if (asleep_) {
            asleep_ = false;
            began_ = t;
        }
        return t;
    }
    /// Work begins, or went on until now without a sleep.
    void begin(Instant now) noexcept { began_ = now; }
    /// The work since then is a turn; the next one begins at once, unless the loop sleeps first.
    void end(Instant now) noexcept;
    /// Everything that was ready at this instant has been done.
    void count(Instant now) noexcept;
    /// The loop lives: `last` counts from here.
    void live(Instant now) noexcept { last_ns_.store(ns_of(now), std::memory_order_relaxed); }
    /// Sets the loop's one timer. One that rings too early costs a turn; so it is only moved forward in time when it must be.
    void arm(Instant deadline);
    [[nodiscard]] Instant armed() const noexcept { return armed_; }
    /// Waits for the next handler and runs it.
    void sleep();

    // --- any thread ---
    /// Instant of the last turn: the watchdog looks at it.
    [[nodiscard]] Instant last() const noexcept { return at_ns(last_ns_.load(std::memory_order_relaxed)); }
    [[nodiscard]] std::uint64_t counted() const noexcept { return count_.load(std::memory_order_relaxed); }
    /// Work between two sleeps.
    [[nodiscard]] const Histogram& times() const noexcept { return times_; }
    /// How long after its time the timer rang.
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
