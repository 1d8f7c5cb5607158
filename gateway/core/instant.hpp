// A point on the gateway's monotonic time line in nanoseconds, and Duration; every pure part takes them as arguments. Only gateway/runtime
// reads a clock; tests make instants up.
#pragma once

#include <chrono>
#include <cstdint>

namespace axisgate {

using Duration = std::chrono::nanoseconds;

/// A clock without `now()`: instants are arguments, so that the same calls give the same results.
struct PureClock {
    using rep = std::int64_t;
    using period = std::nano;
    using duration = Duration;
    using time_point = std::chrono::time_point<PureClock, Duration>;
    static constexpr bool is_steady = true;
};

using Instant = PureClock::time_point;

/// "No deadline": later than every possible instant.
inline constexpr Instant never = Instant::max();

/// The beginning of a simulated world; real time lines start at the value of the runtime's clock.
inline constexpr Instant time_zero{};

[[nodiscard]] constexpr Instant at_ns(std::int64_t ns) noexcept { return Instant{Duration{ns}}; }
[[nodiscard]] constexpr std::int64_t ns_of(Instant t) noexcept { return t.time_since_epoch().count(); }
[[nodiscard]] constexpr double seconds(Duration d) noexcept { return std::chrono::duration<double>(d).count(); }
[[nodiscard]] constexpr std::int64_t milliseconds_of(Duration d) noexcept {
    return std::chrono::duration_cast<std::chrono::milliseconds>(d).count();
}
/// `a + b`, limited to 64 bits: for times from a request or a file.
[[nodiscard]] constexpr std::int64_t saturated_sum(std::int64_t a, std::int64_t b) noexcept {
    std::int64_t sum = 0;
    return !__builtin_add_overflow(a, b, &sum) ? sum : b > 0 ? INT64_MAX : INT64_MIN;
}
[[nodiscard]] constexpr std::int64_t saturated_difference(std::int64_t a, std::int64_t b) noexcept {
    std::int64_t difference = 0;
    return !__builtin_sub_overflow(a, b, &difference) ? difference : b < 0 ? INT64_MAX : INT64_MIN;
}

}  // namespace axisgate
