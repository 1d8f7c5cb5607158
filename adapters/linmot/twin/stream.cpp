#include "adapters/linmot/twin/stream.hpp"

#include <algorithm>

#include "adapters/linmot/twin/bytes.hpp"
#include "adapters/linmot/twin/vai.hpp"

namespace axisgate::linmot::twin {
using std::chrono::milliseconds;

Point Stream::at(Instant now) const {
    const auto& [at, p] = points_.front();
    if (points_.size() < 2 || now <= at) return {p.position, 0};
    const auto& [next_at, q] = points_[1];
    const double period = std::max(1e-9, seconds(next_at - at)), part = std::clamp(seconds(now - at) / period, 0.0, 1.0);
    // With velocities, the fine interpolation passes each set-point with its velocity (cubic), otherwise it is linear.
    if (velocities_) {
        const double way = q.position - p.position, a = p.velocity * period, b = q.velocity * period;
        const double c2 = 3 * way - 2 * a - b, c3 = a + b - 2 * way;
        return {p.position + part * (a + part * (c2 + part * c3)), (a + part * (2 * c2 + 3 * part * c3)) / period};
    }
    return {p.position + (q.position - p.position) * part, (q.position - p.position) / period};
}

Instant Stream::due() const {
    if (points_.size() > 1) return points_[1].first;
    return last_ + (period_ > Duration{} ? period_ * 3 : Duration{milliseconds(8)});
}

bool Stream::pass(Instant now) {
    if (!active_ || points_.size() < 2 || points_[1].first > now) return false;
    points_.pop_front();
    return true;
}

/// Set-points are delayed by 1.5 periods; the period is measured from the first ones, or configured (032xh) [L3914-3944].
Fault Stream::take(std::uint8_t sub, const Bytes& b, Point here, Instant now) {
    if (!active_) {
        active_ = true;
        count_ = 0;
        period_ = sub == 2 ? milliseconds(static_cast<std::int64_t>(std::clamp(memory_.number(0x14E6), 2.0, 5.0))) : Duration{};
        points_.clear();
        points_.emplace_back(now, here);
    } else if (sub != 2 && count_ < 3) {
        const Duration gap = now - last_;
        if (gap < milliseconds(2)) return fail(0x84);
        if (gap > milliseconds(5)) return fail(0x85);
        period_ = gap;
    }
    ++count_;
    last_ = now;
    if (points_.size() > 5) return fail(0x82);
    const Duration period = period_ > Duration{} ? period_ : Duration{milliseconds(2)};
    points_.emplace_back(std::max(now + period * 3 / 2, points_.back().first + Duration{1}),
                         Point{signed32(b, 2), sub == 1 ? signed32(b, 6) * Interpolator::velocity_count : 0});
    velocities_ = sub == 1;
    return 0;
}

}  // namespace axisgate::linmot::twin
