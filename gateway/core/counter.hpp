// A number that one thread counts and any thread reads. Two counters that are read together may belong to slightly different instants.
#pragma once

#include <atomic>
#include <cstdint>

namespace axisgate {

/// One writer, any number of readers; for the writer it is as fast as a plain number.
class Counter {
public:
    void add(std::uint64_t n = 1) noexcept { value_.store(value_.load(std::memory_order_relaxed) + n, std::memory_order_relaxed); }
    void remove(std::uint64_t n = 1) noexcept { value_.store(value_.load(std::memory_order_relaxed) - n, std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t value() const noexcept { return value_.load(std::memory_order_relaxed); }

private:
    std::atomic<std::uint64_t> value_{0};
};

}  // namespace axisgate
