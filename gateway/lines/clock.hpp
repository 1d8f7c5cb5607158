// Clock: the time source of a real line, on the same time line as the rest of the process.
// now() is monotonic. unix_ns() returns the wall-clock time, with which the kernel stamps CAN frames; it follows every change of that
// clock.
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

/// The monotonic clock of the machine, in the form in which the runtime reads it.
struct MachineClock final : Clock {
    [[nodiscard]] Instant now() const override {
        return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
    }
    [[nodiscard]] std::int64_t unix_ns() const override {
        return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
    }
};

/// The one instance that the process uses.
[[nodiscard]] inline const Clock& machine_clock() noexcept {
    static const MachineClock clock;
    return clock;
}

}  // namespace axisgate
