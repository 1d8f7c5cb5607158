// The only place where the time of this machine is read: instants on the monotonic line, which never decrease, and their wall-clock time,
// which follows changes of the wall clock.
#pragma once

#include <chrono>

#include "gateway/core/instant.hpp"

namespace axisgate {

[[nodiscard]] inline Instant monotonic_now() noexcept {
    return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}
[[nodiscard]] inline std::int64_t unix_now_ns() noexcept {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}
/// Wall-clock time of a monotonic instant, by the present difference of the two clocks.
[[nodiscard]] inline std::int64_t unix_ns_of(Instant t) noexcept { return unix_now_ns() + (t - monotonic_now()).count(); }

}  // namespace axisgate
