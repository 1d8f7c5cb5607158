// Log limit: how often one cause may write into the log.
// In: causes and instants. Out: whether to write, and what to tell of those that were held back. Never holds more than `most_causes`.
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
    static constexpr std::size_t most_causes = 512;  ///< those beyond share one
    static constexpr std::uint64_t at_once = 20;     ///< lines of one cause within `period`; the rest is counted
    static constexpr Duration period = std::chrono::seconds(10);

    struct HeldBack {
        std::string cause;
        std::uint64_t lines = 0;
    };
    /// Whether this line is written.
    [[nodiscard]] bool allows(std::string_view cause, Instant now);
    /// Causes whose period has ended and that held lines back: told once. To be called with each line.
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
