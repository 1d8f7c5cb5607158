// Superposition adds a distance to a motion, as defined by SYNCOFFTIME: at a speed at which one marker distance takes that time, with one
// fifth of the time to accelerate and one fifth to decelerate (firmware 6.6.49 on) [L2352-2368]. Without a time it is added at once. One
// step per ms.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace axisgate::aposs {

/// Mean step per ms: SYNCMPULSM / SYNCOFFTIME, integer part; at least 1, because with 0 the distance would never be covered (E-78).
[[nodiscard]] inline std::int64_t offset_step(std::int64_t syncmpulsm, std::int64_t syncofftime) {
    return syncofftime > 0 ? std::max<std::int64_t>(1, syncmpulsm / syncofftime) : 0;
}

class Superposition {
public:
    void reset() { left_ = speed_ = 0; }
    void add(double way) { left_ += way; }
    [[nodiscard]] double left() const noexcept { return left_; }
    double step(std::int64_t syncmpulsm, std::int64_t syncofftime) {
        if (left_ == 0) return 0;
        const auto mean = static_cast<double>(offset_step(syncmpulsm, syncofftime));
        if (mean == 0) return std::exchange(left_, 0.0);  // E-57
        const double top = mean / 0.8, rate = top / std::max(1.0, 0.2 * static_cast<double>(syncofftime));
        const double size = std::fabs(left_), side = std::copysign(1.0, left_);
        double now = speed_ * side;
        now = std::min({now + rate, top, std::sqrt(2 * rate * size) + rate / 2});
        now = std::clamp(now, std::min(size, rate), size);
        if (size - now < 1e-6) {
            speed_ = 0;
            return std::exchange(left_, 0.0);
        }
        left_ -= side * now;
        speed_ = side * now;
        return speed_;
    }

private:
    double left_ = 0, speed_ = 0;
};

}  // namespace axisgate::aposs
