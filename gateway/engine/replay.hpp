// Replay: a recording played through an engine of its own: the recorded inputs, in virtual time, with the same adapters and twins.
// In: the inputs since the first site, and a stretch of what came of them. Out: where this program does otherwise than the recording.
// Never opens a line: a cable is played from what came over it. No clock, file or thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gateway/core/family.hpp"
#include "gateway/engine/flight_record.hpp"

namespace axisgate {

struct ReplayInput {
    std::span<const char> inputs;       ///< FlightLog: every input since the start, the site first
    std::span<const char> window;       ///< FlightLog: the last stretch, inputs and outcomes; inputs are passed over
    std::uint64_t outcomes_before = 0;  ///< how many outcomes came before the window
};

struct ReplayReport {
    static constexpr std::size_t most_listed = 20;
    struct Difference {
        std::string recorded, replayed;  ///< a line for people each; empty: there is none on that side
    };
    std::string fault;  ///< not empty: it could not be played (to its end), and why
    std::uint64_t inputs = 0, compared = 0, differences = 0;
    std::vector<Difference> listed;  ///< the first ones
    Duration span{};                 ///< of the recording, from the first input to the last
};

[[nodiscard]] ReplayReport replay(const Families& families, const ReplayInput& recording);

}  // namespace axisgate
