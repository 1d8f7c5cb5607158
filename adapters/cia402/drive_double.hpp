// Double: whether two nodes have one number: the heartbeats of each come in the gaps of the other's, and each question is answered twice.
// In: heartbeats, answers, time. Out: true when it is past doubt, once for as long as it goes on. Never takes one early heartbeat, or a
// late answer, for a second node.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "gateway/core/instant.hpp"

namespace axisgate::cia402_drive {

class DoubleBeat {
public:
    /// It is looked at anew. `period`: what the node has acknowledged; zero: none, and its heartbeats say nothing of this.
    void begin(Duration period) noexcept {
        period_ = period;
        beat_.reset();
        early_ = in_time_ = 0;
    }
    [[nodiscard]] bool beat(Instant now) noexcept {
        const auto before = std::exchange(beat_, now);
        if (!before || period_ <= Duration::zero()) return false;
        // Of the two gaps between two nodes' beats one is at most half a period long; of one node none is, but for delays.
        if (now - *before < 5 * period_ / 8) {
            in_time_ = 0;
            return ++early_ == enough;
        }
        if (++in_time_ >= 2) early_ = 0;
        return false;
    }
    /// It has started: the gap before its next heartbeat is as long as it likes.
    void restarted() noexcept { beat_.reset(); }

private:
    static constexpr int enough = 4;
    Duration period_{};
    std::optional<Instant> beat_{};
    int early_ = 0, in_time_ = 0;
};

/// A late answer happens; one to every question means that there are two who answer.
class DoubleAnswer {
public:
    /// An answer came to a question that was not asked, or had its answer.
    void stray() noexcept { stray_ = true; }
    [[nodiscard]] bool answered() noexcept {
        in_a_row_ = std::exchange(stray_, false) ? std::min(in_a_row_ + 1, enough + 1) : 0;
        return in_a_row_ == enough;
    }

private:
    static constexpr int enough = 12;
    bool stray_ = false;  ///< to the question before this one
    int in_a_row_ = 0;
};

}  // namespace axisgate::cia402_drive
