// Detects that two nodes have the same number: their heartbeats arrive between each other, and each SDO request is answered twice. One
// early heartbeat or one late answer is not sufficient. A duplicate is reported once.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "gateway/core/instant.hpp"

namespace axisgate::cia402_drive {

class DoubleBeat {
public:
    /// Begins again. `period` is the heartbeat period that the node has accepted; zero: no heartbeats, so that they prove nothing.
    void begin(Duration period) noexcept {
        period_ = period;
        beat_.reset();
        early_ = in_time_ = 0;
    }
    [[nodiscard]] bool beat(Instant now) noexcept {
        const auto before = std::exchange(beat_, now);
        if (!before || period_ <= Duration::zero()) return false;
        // Of two nodes, one of the two gaps between heartbeats is at most half a period; with one node, no gap is so short except after a
        // delay.
        if (now - *before < 5 * period_ / 8) {
            in_time_ = 0;
            return ++early_ == enough;
        }
        if (++in_time_ >= 2) early_ = 0;
        return false;
    }
    /// The node has started: the time until its next heartbeat is not defined.
    void restarted() noexcept { beat_.reset(); }

private:
    static constexpr int enough = 4;
    Duration period_{};
    std::optional<Instant> beat_{};
    int early_ = 0, in_time_ = 0;
};

/// One late answer is possible. A second answer to every request proves that two nodes answer.
class DoubleAnswer {
public:
    /// An answer arrived that was not requested, or for the second time.
    void stray() noexcept { stray_ = true; }
    [[nodiscard]] bool answered() noexcept {
        in_a_row_ = std::exchange(stray_, false) ? std::min(in_a_row_ + 1, enough + 1) : 0;
        return in_a_row_ == enough;
    }

private:
    static constexpr int enough = 12;
    bool stray_ = false;  ///< on the request before the present one
    int in_a_row_ = 0;
};

}  // namespace axisgate::cia402_drive
