// Stream follows the set-points of a master (03h): it measures their period and interpolates between them, delayed by one and a half
// periods. Errors 0082h, 0084h, 0085h, and a missing set-point. The demand never passes the last set-point.
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
    /// When the next set-point is reached or, after the last, when one is missing. While it is active.
    [[nodiscard]] Instant due() const;

    /// A set-point of sub ID 0 to 2; `here`: the demand. After an error the stream has ended.
    [[nodiscard]] Fault take(std::uint8_t sub, const Bytes& b, Point here, Instant now);
    /// True: the next set-point has been reached.
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
    Instant last_{};     ///< the last set-point
    Duration period_{};  ///< 0: not measured yet
    int count_ = 0;
    bool velocities_ = false;                       ///< the set-points have velocities (031xh)
    std::deque<std::pair<Instant, Point>> points_;  ///< the first one is the start of the present way; at most 7
};

}  // namespace axisgate::linmot::twin
