// The search for an index pulse is limited to one turn.
#include "adapters/aposs/twin/homing.hpp"

#include <cmath>

namespace axisgate::aposs {

HomingRun::Order HomingRun::begin(const HomingParameters& p, const HomingInput& in) {
    p_ = p;
    before_ = in.place;
    if (in.on_switch) return leave();
    phase_ = Phase::search;
    return {p_.velocity, {}};
}
HomingRun::Order HomingRun::leave() {
    phase_ = Phase::leave;
    was_on_ = !p_.reverses();  // with reversal, the axis may have overrun the switch: the switch counts after the reversal
    return {p_.leaving(), {}};
}
/// "After homing the drive is positioned to HOME_OFFSET. At this point the machine zero point or index is set" [L3655].
HomingRun::Order HomingRun::to_offset(double reference) {
    phase_ = Phase::offset;
    zero_ = reference + p_.offset;
    return {{}, zero_};
}

HomingRun::Order HomingRun::step(const HomingInput& in) {
    const double before = before_;
    before_ = in.place;
    switch (phase_) {
        case Phase::search:
            return in.on_switch ? leave() : Order{};
        case Phase::leave:
            if (p_.reverses() && (in.place - before) * p_.leaving() <= 0) return {};
            was_on_ = was_on_ || in.on_switch;
            if (in.on_switch || !was_on_) return {};
            if (!p_.to_index()) return to_offset(in.place);
            phase_ = Phase::index;
            from_ = in.place;
            return {};
        case Phase::index: {
            const double turn = p_.index_distance;
            const double a = std::floor(before / turn), b = std::floor(in.place / turn);
            if (in.index_pulses && a != b) return to_offset(turn * (b > a ? b : a));
            if (std::fabs(in.place - from_) <= turn + std::fabs(in.place - before)) return {};
            phase_ = Phase::index_missed;
            return {0.0, {}};
        }
        case Phase::offset:
            if (in.stands) phase_ = Phase::done;
            return {};
        default:
            return {};
    }
}

}  // namespace axisgate::aposs
