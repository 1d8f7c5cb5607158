// Limits the number of log lines per cause, and reports how many were suppressed. Bounded by `most_causes`; the time is an argument.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "gateway/core/instant.hpp"

namespace axisgate {

class LogLimit {
public:
    static constexpr std::size_t most_causes = 512;  ///< causes beyond this number share one entry
    static constexpr std::uint64_t at_once = 20;     ///< lines of one cause within `period`; the others are counted
    static constexpr Duration period = std::chrono::seconds(10);

    struct HeldBack {
        std::string cause;
        std::uint64_t lines = 0;
    };
    /// True if this line is to be written.
    [[nodiscard]] bool allows(std::string_view cause, Instant now);
    /// Causes whose period has ended and that suppressed lines, each once. Must be called with each line.
    [[nodiscard]] std::vector<HeldBack> ended(Instant now);

private:
    struct State {
        Instant begun{};
        std::uint64_t lines = 0;
    };
    std::unordered_map<std::string, State> causes_;
    Instant next_look_{};
};

}  // namespace axisgate
