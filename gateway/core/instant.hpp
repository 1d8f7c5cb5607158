// Instant: a point on the gateway's monotonic time line, in nanoseconds.
// In: nothing. Out: the types Instant and Duration, which every pure part takes as arguments.
// Never reads a clock: only gateway/runtime does that, and tests make instants up.
#pragma once

#include <chrono>
#include <cstdint>

namespace axisgate {

using Duration = std::chrono::nanoseconds;

/// A clock without `now()`: instants are handed in, so the same calls give the same results.
struct PureClock {
    using rep = std::int64_t;
    using period = std::nano;
    using duration = Duration;
    using time_point = std::chrono::time_point<PureClock, Duration>;
    static constexpr bool is_steady = true;
};

using Instant = PureClock::time_point;

/// "No deadline": later than every instant that can happen.
inline constexpr Instant never = Instant::max();

/// The beginning of a simulated world; real time lines start wherever the runtime's clock says.
inline constexpr Instant time_zero{};

[[nodiscard]] constexpr Instant at_ns(std::int64_t ns) noexcept { return Instant{Duration{ns}}; }
[[nodiscard]] constexpr std::int64_t ns_of(Instant t) noexcept { return t.time_since_epoch().count(); }
[[nodiscard]] constexpr double seconds(Duration d) noexcept { return std::chrono::duration<double>(d).count(); }
[[nodiscard]] constexpr std::int64_t milliseconds_of(Duration d) noexcept {
    return std::chrono::duration_cast<std::chrono::milliseconds>(d).count();
}
/// `a + b`, or the end of what 64 bits hold: for times that somebody asks for, or that a file tells.
[[nodiscard]] constexpr std::int64_t saturated_sum(std::int64_t a, std::int64_t b) noexcept {
    std::int64_t sum = 0;
    return !__builtin_add_overflow(a, b, &sum) ? sum : b > 0 ? INT64_MAX : INT64_MIN;
}
[[nodiscard]] constexpr std::int64_t saturated_difference(std::int64_t a, std::int64_t b) noexcept {
    std::int64_t difference = 0;
    return !__builtin_sub_overflow(a, b, &difference) ? difference : b < 0 ? INT64_MAX : INT64_MIN;
}

}  // namespace axisgate
