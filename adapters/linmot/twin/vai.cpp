#include "adapters/linmot/twin/vai.hpp"

#include <algorithm>

namespace axisgate::linmot::twin {

Ramps Interpolator::predefined() const {
    return {memory_.number(0x14BE) * velocity_count, memory_.number(0x14BF) * acceleration_count,
            memory_.number(0x14C0) * acceleration_count};
}

void Interpolator::move(Point from, double target, const Ramps& ramps, Instant now) noexcept {
    profile_.move(now, from, target, ramps);
    target_ = target;
}

/// Start rules by sub ID: the target, and the start of the profile.
void Interpolator::start(const Order& o, Point from, Point actual, Instant now) noexcept {
    double target = o.value;
    switch (o.sub) {
        case 1:
            target += from.position;
            break;
        case 2:
            target += target_;
            break;
        case 3:
            from = actual;
            break;
        case 4:
            from = {actual.position, 0};
            break;
        case 5:
            target += actual.position;
            break;
        case 6:
            target += actual.position;
            from = {actual.position, 0};
            break;
        default:
            break;
    }
    used_ = true;
    last_ramps_ = o.ramps;
    move(from, target, o.ramps, now);
}

void Interpolator::endless(Point from, double direction, const Ramps& ramps, Instant now) noexcept {
    last_ramps_ = ramps;
    used_ = true;
    profile_.run(now, from, direction, ramps);
}

void Interpolator::change(Point from, const Ramps& ramps, Instant now) noexcept {
    last_ramps_ = ramps;
    if (profile_.endless())
        profile_.run(now, from, from.velocity < 0 ? -1 : 1, ramps);
    else if (!profile_.over(now))
        profile_.move(now, from, profile_.target(), ramps);
}

void Interpolator::stop(Point from, double deceleration, Instant now) noexcept {
    after_.reset();
    profile_.stop(now, from, std::max(deceleration, 1.0));
    target_ = profile_.target();
}

void Interpolator::freeze(Point from, bool led, bool moved, Instant now) noexcept {
    frozen_.motion = moved;
    frozen_.target = led ? (used_ ? target_ : 0.0) : profile_.target();
    frozen_.endless = !led && profile_.endless();
    frozen_.direction = from.velocity < 0 ? -1 : 1;
    after_.reset();
    profile_.stop(now, from, quick_deceleration);
}

void Interpolator::thaw(Point from, Instant now) noexcept {
    if (!frozen_.motion) return;
    if (frozen_.endless)
        profile_.run(now, from, frozen_.direction, last_ramps_);
    else
        profile_.move(now, from, frozen_.target, used_ ? last_ramps_ : predefined());
}

}  // namespace axisgate::linmot::twin
