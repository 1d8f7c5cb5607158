// Counters: what the Modbus door has done since it was opened, for /metrics.
// In: counted by the hot thread alone. Out: read by any thread at any time; every number by itself is right, two of them may be a moment
// apart. Never goes back.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "gateway/doors/modbus/wire.hpp"

namespace axisgate::modbus {

/// One writer, any number of readers; costs the writer no more than a plain number.
class Counter {
public:
    void add(std::uint64_t n = 1) noexcept { value_.store(value_.load(std::memory_order_relaxed) + n, std::memory_order_relaxed); }
    void remove(std::uint64_t n = 1) noexcept { value_.store(value_.load(std::memory_order_relaxed) - n, std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t value() const noexcept { return value_.load(std::memory_order_relaxed); }

private:
    std::atomic<std::uint64_t> value_{0};
};

struct Counters {
    Counter requests;                    ///< whole ADUs taken for an answer
    std::array<Counter, 16> exceptions;  ///< answers, by exception code (index 1..0x0B)
    Counter commands;                    ///< given to the engine
    Counter results_unclaimed;           ///< results that nobody waited for any more: the client has gone, or it came after the time-out
    Counter results_timed_out;           ///< answered with exception 0x0B by the door itself

    Counter connections_open;  ///< gauge
    Counter connections_accepted;
    Counter connections_refused;  ///< the limit is reached and no connection is idle
    Counter connections_not_allowed;  ///< closed at once: the peer is not on the allow list
    Counter connections_evicted;  ///< closed, the longest idle one, to make room
    Counter closed_idle;          ///< no request for the idle time-out
    Counter closed_not_modbus;    ///< bad protocol id or length
    Counter closed_partial;       ///< half a request, and then nothing for the partial time-out
    Counter closed_not_reading;   ///< the client did not take its answers
    Counter bytes_received;
    Counter bytes_sent;

    void count(Exception e) noexcept { exceptions[static_cast<std::size_t>(e) & 15u].add(); }
};

}  // namespace axisgate::modbus
