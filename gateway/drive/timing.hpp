// Timing: how long one waits for an answer and how often one asks, as the site has it, with a family's own defaults filled in.
// In: the line's setup, the family's defaults. Out: numbers that are in their ranges. Never changes while an adapter is not configured
// anew.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gateway/core/setup.hpp"

namespace axisgate::drive {

/// A family gives one of these with what its manual says, or what was chosen where that is silent.
struct Timing {
    Duration reply_timeout = std::chrono::milliseconds(100);  ///< wait for one answer, besides the time on the wire; above 0
    Duration poll_period = std::chrono::milliseconds(20);     ///< between two polls of an axis that moves; above 0
    Duration pause{};                                         ///< silence between an answer and the next request; 0: none
    int retries = 2;                                          ///< further attempts of what may be repeated, 0..10
    int silent_limit = 3;                                     ///< exchanges without an answer until a drive is absent, 1..1000
    Duration pause_min = std::chrono::milliseconds(200);      ///< first pause before an absent drive is asked again; above 0 ...
    Duration pause_max = std::chrono::seconds(5);             ///< ... which doubles up to this; never below pause_min
};

/// What the site says, where it says something, within the ranges above; else `defaults`.
[[nodiscard]] Timing timing_of(const LineTiming& site, const Timing& defaults) noexcept;

/// How many exchanges of `exchange` time each fit into `time`: `least`..`most`, and `most` where the exchange takes no time that is known.
[[nodiscard]] std::size_t fitting(Duration time, Duration exchange, std::size_t least, std::size_t most) noexcept;

}  // namespace axisgate::drive
