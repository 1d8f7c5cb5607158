// Decides when the service thread may have a real-time rank: it runs before other programs when it is woken, and never occupies a processor
// permanently. Reason: the kernel lets a waking thread of the normal policy wait behind threads that have used less than their share, and
// the program's own threads keep a processor for a millisecond and more. One in five thousand commands over HTTP took longer than that; of
// Modbus writes, which the hot thread answers, one in twenty-five thousand.
#pragma once

#include "gateway/core/instant.hpp"

namespace axisgate {

class ServiceRank {
public:
    /// In each `window` the rank is kept for at most `most` of processor time; the rest is left for other threads.
    static constexpr Duration window = std::chrono::milliseconds(50), most = std::chrono::milliseconds(30);
    /// `used` is the thread's processor time since it began.
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
