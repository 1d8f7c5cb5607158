// Double beat: whether the heartbeats of one number come from two nodes: each comes in a gap of the other's.
// In: heartbeats, time. Out: true when it is past doubt, once for as long as it goes on. Never takes one early heartbeat for a second node.
#pragma once

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

}  // namespace axisgate::cia402_drive
