// Clock: where a real line takes its time from: the same time line as everything else of the process.
// In: nothing. Out: instants, and the wall-clock time that belongs to them (the kernel stamps CAN frames with that one).
// Never goes backwards in now(); unix_ns() follows the wall clock, jumps included.
#pragma once

#include <chrono>
#include <cstdint>

#include "gateway/core/instant.hpp"

namespace axisgate {

struct Clock {
    [[nodiscard]] virtual Instant now() const = 0;
    /// Nanoseconds since 1970.
    [[nodiscard]] virtual std::int64_t unix_ns() const = 0;
    virtual ~Clock() = default;
};

/// The machine's monotonic clock, in the form in which the runtime reads it.
struct MachineClock final : Clock {
    [[nodiscard]] Instant now() const override {
        return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
    }
    [[nodiscard]] std::int64_t unix_ns() const override {
        return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
    }
};

/// A machine has one.
[[nodiscard]] inline const Clock& machine_clock() noexcept {
    static const MachineClock clock;
    return clock;
}

}  // namespace axisgate
