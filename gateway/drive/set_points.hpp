// SetPoints holds the streamed set-points that wait for transmission: only the newest of each axis, in the order in which the axes began to
// wait. Its bound is the number of axes of the drive.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "gateway/core/command.hpp"

namespace axisgate::drive {

class SetPoints {
public:
    /// Replaces the waiting set-point of the same axis.
    void put(const SetPoint& p) {
        const auto it = std::ranges::find(waiting_, p.axis, &SetPoint::axis);
        if (it == waiting_.end()) return waiting_.push_back(p);
        *it = p;
    }
    [[nodiscard]] bool empty() const noexcept { return waiting_.empty(); }
    [[nodiscard]] SetPoint take() {
        SetPoint p = std::move(waiting_.front());
        waiting_.erase(waiting_.begin());
        return p;
    }
    /// To be called when a command moves or stops the axis: a waiting set-point would cancel the command.
    void forget(AxisId axis) {
        std::erase_if(waiting_, [axis](const SetPoint& p) { return p.axis == axis; });
    }
    void clear() noexcept { waiting_.clear(); }

private:
    std::vector<SetPoint> waiting_;
};

}  // namespace axisgate::drive
