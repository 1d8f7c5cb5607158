// Set-points that a master streams: how far apart they come, and the way between them, one and a half periods late.
// In: motion commands of 03h, time. Out: the demand; errors 0082h, 0084h, 0085h, and that no set-point came in time.
// Never goes on past its last set-point.
#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "adapters/linmot/twin/memory.hpp"
#include "adapters/linmot/twin/order.hpp"

namespace axisgate::linmot::twin {

class Stream {
public:
    explicit Stream(const Memory& memory) : memory_(memory) {}

    [[nodiscard]] bool active() const noexcept { return active_; }
    /// While it is active.
    [[nodiscard]] Point at(Instant now) const;
    /// When the next set-point is reached or, behind the last, when one is missed. While it is active.
    [[nodiscard]] Instant due() const;

    /// A set-point of sub ID 0 to 2; `here`: the demand. With an error the stream has ended.
    [[nodiscard]] Fault take(std::uint8_t sub, const Bytes& b, Point here, Instant now);
    /// The next set-point is reached: true, and it is behind now.
    bool pass(Instant now);
    [[nodiscard]] bool starved(Instant now) const { return active_ && points_.size() <= 1 && now >= due(); }
    void end() noexcept { active_ = false; }

private:
    Fault fail(Fault fault) noexcept {
        active_ = false;
        return fault;
    }
    const Memory& memory_;
    bool active_ = false;
    Instant last_{};     ///< set-point that came
    Duration period_{};  ///< 0: it is being measured
    int count_ = 0;
    bool velocities_ = false;                       ///< its set-points have velocities (031xh)
    std::deque<std::pair<Instant, Point>> points_;  ///< the first one is where the way comes from; bounded by 7
};

}  // namespace axisgate::linmot::twin
