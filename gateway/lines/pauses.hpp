// Pauses: the pauses between attempts, each twice as long as the one before, up to a bound. It has no clock.
#pragma once

#include <algorithm>
#include <chrono>

#include "gateway/core/instant.hpp"

namespace axisgate {

struct PauseRange {
    Duration first = std::chrono::milliseconds(200);
    Duration last = std::chrono::seconds(5);
};

class GrowingPause {
public:
    explicit GrowingPause(const PauseRange& range) noexcept : range_(range), next_(range.first) {}
    /// The pause before the next attempt; the one after it is twice as long.
    [[nodiscard]] Duration take() noexcept {
        const Duration d = next_;
        next_ = std::min(next_ * 2, range_.last);
        return d;
    }
    void reset() noexcept { next_ = range_.first; }

private:
    PauseRange range_;
    Duration next_;
};

}  // namespace axisgate
