#include "gateway/drive/lead.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::drive {

double Lead::speed_towards(double wanted, const LeadRamps& ramps, double cycle_s) noexcept {
    const bool slower = std::fabs(wanted) < std::fabs(velocity_) || wanted * velocity_ < 0;
    const double step = (slower ? ramps.deceleration : ramps.acceleration) * cycle_s;
    velocity_ += std::clamp(wanted - velocity_, -step, step);
    return velocity_;
}

double Lead::towards(double target, const LeadRamps& ramps, double cycle_s) noexcept {
    if (cycle_s <= 0) return place_;
    const double way = target - place_, step = ramps.deceleration * cycle_s, half = step / 2;
    // The highest speed from which the axis stops at the target, in steps of one cycle.
    const double brake = std::sqrt(half * half + 2 * ramps.deceleration * std::fabs(way)) - half;
    speed_towards(std::copysign(std::min({ramps.velocity, brake, std::fabs(way) / cycle_s}), way), ramps, cycle_s);
    if (std::fabs(way) <= std::fabs(velocity_) * cycle_s + 0.5 && std::fabs(velocity_) <= 2 * step + 1) {
        place_ = target;
        if (std::fabs(way) < 0.5) velocity_ = 0;
    } else {
        place_ += velocity_ * cycle_s;
    }
    return place_;
}

}  // namespace axisgate::drive
