// Plays the inputs of a recording through an engine of its own, in virtual time, with the same adapters and twins, and reports where this
// program differs from the recording. Cables are played from the recorded frames. There is no clock, file or thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gateway/core/family.hpp"
#include "gateway/engine/flight_record.hpp"

namespace axisgate {

struct ReplayInput {
    std::span<const char> inputs;       ///< FlightLog: every input since the start, beginning with the site
    std::span<const char> window;       ///< FlightLog: the last period with inputs and outcomes; its inputs are skipped
    std::uint64_t outcomes_before = 0;  ///< number of outcomes before the window
};

struct ReplayReport {
    static constexpr std::size_t most_listed = 20;
    struct Difference {
        std::string recorded, replayed;  ///< one line each, for people; empty if this side has none
    };
    std::string fault;  ///< not empty if the recording could not be played to its end: the reason
    std::uint64_t inputs = 0, compared = 0, differences = 0;
    std::vector<Difference> listed;  ///< the first differences
    Duration span{};                 ///< of the recording, from the first to the last input
};

[[nodiscard]] ReplayReport replay(const Families& families, const ReplayInput& recording);

}  // namespace axisgate
