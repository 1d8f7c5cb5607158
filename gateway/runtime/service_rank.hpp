// Service rank: how the service thread goes before other programs when it is woken, and never keeps a processor from them.
// In: the clock, what the thread has used of its processor. Out: whether it may have a real-time rank. Pure.
// Why: the kernel lets a waking thread of the normal policy wait behind whoever has had less than its share, and its own threads hold a
// processor for a millisecond and more. Of commands over HTTP one in five thousand took longer than that, of Modbus writes, which the hot
// thread answers, one in twenty-five thousand.
#pragma once

#include "gateway/core/instant.hpp"

namespace axisgate {

class ServiceRank {
public:
    /// In each `window` the rank is kept for at most `most` of the processor's time; the rest is left for all others.
    static constexpr Duration window = std::chrono::milliseconds(50), most = std::chrono::milliseconds(30);
    /// `used`: by the thread since it began.
    [[nodiscard]] bool may_go_first(Instant now, Duration used) noexcept {
        if (now - begun_ >= window) {
            begun_ = now;
            used_before_ = used;
        }
        return used - used_before_ < most;
    }

private:
    Instant begun_{};
    Duration used_before_{};
};

}  // namespace axisgate
