// Trouble: answers of one drive that are late, cut, spoiled, lost or doubled, gathered into few notices.
// In: one such answer, the time. Out: now and then a sentence with counts.
// Never tells of a single one (unless asked to), nor more often than once a minute.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>

#include "gateway/core/instant.hpp"

namespace axisgate::mcode {

class Trouble {
public:
    enum class Kind : std::uint8_t { late, cut, garbled, lost, twice };
    static constexpr std::size_t kinds = 5;
    static constexpr Duration window = std::chrono::seconds(10), pause = std::chrono::minutes(1);

    /// Told from the `from`-th within `window` on.
    explicit Trouble(std::size_t from = 3) : from_(from) {}
    /// Counts it. What to tell now ("2 late, 1 lost in 60 s"); empty: nothing.
    [[nodiscard]] std::string add(Kind kind, Instant now);

private:
    std::size_t from_;
    std::array<std::uint32_t, kinds> counts_{};
    std::deque<Instant> recent_;  ///< at most `from_`
    Instant since_{};             ///< of the counts
    Instant reported_{};
    bool ever_ = false;
};

}  // namespace axisgate::mcode
