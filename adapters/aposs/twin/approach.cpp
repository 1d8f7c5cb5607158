// The manual leaves details open; they are decided in E-79.
#include "adapters/aposs/twin/approach.hpp"

namespace axisgate::aposs {
namespace {
constexpr double near_zero = 0.02;  ///< qc/ms: one quad count in the time of the smallest filter
constexpr double most_markers = 3;  ///< longest wait; usually the curve begins within two
}  // namespace

/// The velocity changes by 3s^2 - 2s^3, over the way of the mean velocity; the remaining distance to the marker by 10s^3 - 15s^4 + 6s^5.
double Approach::along(double s) const {
    const double s3 = s * s * s, s4 = s3 * s;
    return from_ + time_ * (from_velocity_ * s + gain_ * (s3 - s4 / 2)) + rest_ * (10 * s3 - 15 * s4 + 6 * s4 * s);
}

double Approach::step(const ApproachMaster& to, const ApproachLimits& limits, const ApproachInput& in) {
    speed_ = seen_ ? speed_ + (in.way - speed_) / to.filter_ms : in.way;
    seen_ = true;
    waited_ += 1;
    if (phase_ == Phase::waits) {
        const double slave_speed = std::fabs(speed_ * to.gear), marker_ms = to.pulse / std::max(std::fabs(speed_), near_zero);
        if (waited_ < to.filter_ms) return in.command + in.velocity;
        if (std::fabs(speed_) < near_zero || to.pulse <= 0 || !in.slave_marker || slave_speed > limits.velocity ||
            waited_ > to.filter_ms + most_markers * marker_ms)
            phase_ = Phase::given_up;
        else if (in.master_marker)
            start(to, limits, in);
        return in.command + in.velocity;
    }
    const double share = master_way_ != 0 ? (in.master - begun_at_) / master_way_ : 1;
    if (std::fabs(speed_ - begun_speed_) > 0.1 * std::fabs(begun_speed_)) {
        phase_ = Phase::given_up;
        return in.command + in.velocity;
    }
    if (share < 1) return along(std::max(0.0, share));
    phase_ = Phase::arrived;  // the last step ends after the marker and continues with the master
    return along(1) + (share - 1) * master_way_ * to.gear;
}

/// Begins where the way of the present speeds ends at a marker when the master is at a marker.
void Approach::start(const ApproachMaster& to, const ApproachLimits& limits, const ApproachInput& in) {
    const double goal = speed_ * to.gear, gain = goal - in.velocity, change = std::fabs(gain);
    double least = limits.acceleration > 0 ? 1.5 * change / limits.acceleration : 0;
    if (limits.jerk > 0) least = std::max(least, std::sqrt(6 * change / limits.jerk));
    least = std::max(least, 1.0);
    // The way of the master to the next marker, and to further ones.
    const double side = std::copysign(1.0, speed_), past = std::fmod((in.master - *in.master_marker) * side, to.pulse);
    const double ahead = to.pulse - (past < 0 ? past + to.pulse : past);
    const double whole = std::max(0.0, std::ceil((least * std::fabs(speed_) - ahead) / to.pulse));
    for (const double more : {0.0, 1.0}) {
        const double way = side * (ahead + (whole + more) * to.pulse), time = way / speed_;
        const double slave_way = time * (in.velocity + goal) / 2;
        const double wanted = *in.slave_marker + (in.master + way - *in.master_marker) * to.gear;
        const double rest = nearest(wanted - in.command - in.velocity - slave_way, to.cycle);
        if (std::fabs(rest) > std::max(1.0, std::fabs(goal))) continue;
        phase_ = Phase::runs;
        begun_speed_ = speed_;
        begun_at_ = in.master;
        master_way_ = way;
        from_ = in.command + in.velocity;
        time_ = time;
        from_velocity_ = in.velocity;
        gain_ = gain;
        rest_ = rest;
        return;
    }
}

}  // namespace axisgate::aposs
