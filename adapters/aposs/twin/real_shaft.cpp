#include "adapters/aposs/twin/real_shaft.hpp"

#include <cmath>

namespace axisgate::aposs {

void RealShaft::follow(Calculated& by, bool powered, Instant now) {
    if (!shaft_.differs()) return;
    if (by.held()) {
        shaft_.set(by.shaft(now).position, now);
    } else if (powered || by.moves(now)) {
        shaft_.advance(now, [&](Instant at) { return by.shaft(at).position; });
        was_on_ = true;
    } else if (!was_on_) {
        shaft_.set(by.shaft(now).position, now);
    } else {
        shaft_.advance_without_power(now);
        by.rest_at(shaft_.position(), now);
    }
    deviation_ = shaft_.shown() - by.shaft(now).position;
    misread(by, jump_);
}

bool RealShaft::unsettled(const Calculated& by, bool powered, Instant now) const {
    if (!shaft_.differs() || by.held() || !(powered || by.moves(now))) return false;
    return by.moves(now) || shaft_.velocity() != 0 || std::fabs(shaft_.following_error()) > friction_ + 1;
}

void RealShaft::misread(Calculated& by, double jump) {
    jump_ = jump;
    by.misread(jump_ + deviation_);
}

}  // namespace axisgate::aposs
