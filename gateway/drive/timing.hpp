// The time-outs, periods and pauses of a line: the values of the site, completed by the defaults of the family and limited to their ranges.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gateway/core/setup.hpp"

namespace axisgate::drive {

/// A family defines its defaults from its manual, or chooses them if the manual is silent.
struct Timing {
    Duration reply_timeout = std::chrono::milliseconds(100);  ///< wait for one answer, in addition to the transmission time; above 0
    Duration poll_period = std::chrono::milliseconds(20);     ///< between two polls of a moving axis; above 0
    Duration pause{};                                         ///< silence between an answer and the next request; 0: none
    int retries = 2;                                          ///< repetitions of requests that may be repeated, 0..10
    int silent_limit = 3;                                     ///< consecutive time-outs after which a drive is absent, 1..1000
    Duration pause_min = std::chrono::milliseconds(200);      ///< first pause before an absent drive is probed again; above 0 ...
    Duration pause_max = std::chrono::seconds(5);             ///< ... which doubles up to this value; never below pause_min
};

/// The values of the site, limited to the ranges above; `defaults` for values that the site does not give.
[[nodiscard]] Timing timing_of(const LineTiming& site, const Timing& defaults) noexcept;

/// How many exchanges of `exchange` each fit into `time`, within `least`..`most`; `most` if the time of an exchange is not known.
[[nodiscard]] std::size_t fitting(Duration time, Duration exchange, std::size_t least, std::size_t most) noexcept;

}  // namespace axisgate::drive
