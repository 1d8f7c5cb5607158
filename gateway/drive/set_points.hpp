// SetPoints: the streamed set-points that wait for a place on the wire: the newest of each axis and no other.
// In: set-points, what takes them away. Out: the next one, in the order in which axes began to wait. Never sends; never holds more than one
// per axis, so its bound is the axes of the drive.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "gateway/core/command.hpp"

namespace axisgate::drive {

class SetPoints {
public:
    /// Takes the place of the one that its axis has waiting.
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
    /// A command moves or stops the axis: what waits would undo it.
    void forget(AxisId axis) {
        std::erase_if(waiting_, [axis](const SetPoint& p) { return p.axis == axis; });
    }
    void clear() noexcept { waiting_.clear(); }

private:
    std::vector<SetPoint> waiting_;
};

}  // namespace axisgate::drive
