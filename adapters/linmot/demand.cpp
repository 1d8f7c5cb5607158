// Where the axis should be: worked out from the moves that the drive has acknowledged, since its default response has the position alone.
// In: beginnings and ends of motions. Out: demand and its source in the feedback. Forgotten where a motion is not the gateway's own.
#include <cmath>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {

void Drive::demand_moves(Turn& t) {
    const DemandRamps ramps{.acceleration = move_a_ * 100.0 + (move_a_ == 0 ? 1 : 0), .deceleration = move_d_ * 100.0, .start_speed = 0};
    if (!demand_.known()) {
        if (fb_.moving && fb_.velocity != 0) return;
        demand_.rest(static_cast<double>(status_.position));
    }
    const Move& m = demand_move_;
    const double v = move_v_ * 10.0;
    if (m.kind == Move::Kind::velocity)
        return demand_.run(t.now, m.target == 0 ? 0 : std::copysign(v, static_cast<double>(m.target)), ramps);
    const double target = static_cast<double>(m.target) + (m.kind == Move::Kind::relative ? demand_.at(t.now).position : 0);
    demand_.move(t.now, target, v, ramps);
}

void Drive::demand_stops(Turn& t) {
    if (!demand_.known()) return;
    if (status_.state() != state::enabled) return demand_.forget();  // on a ramp that is not known
    demand_.stop(
        t.now,
        {.acceleration = move_a_ * 100.0 + 1, .deceleration = (move_d_ ? move_d_ : dec_.value_or(100'000)) * 100.0, .start_speed = 0});
}

void Drive::demand_at_status(Turn& t) {
    const bool held = status_.state() >= state::enabled && status_.state() != state::quick_stop;
    if (!held || status_.state() == state::homing)
        demand_.forget();
    else if (!demand_.known() && !fb_.moving)
        demand_.rest(static_cast<double>(status_.position));
    // It stands before it should: somebody else has ended the motion.
    else if (demand_.known() && !fb_.moving && !motion_fresh_ &&
             !demand_.over(t.now + bus_.timing.reply_timeout + std::chrono::milliseconds(20)))
        demand_.rest(static_cast<double>(status_.position));
    fb_.demand_source = demand_.known() ? DemandSource::computed : DemandSource::none;
    fb_.position_demand = demand_.known() ? std::llround(demand_.at(t.now).position) : fb_.position;
}

}  // namespace axisgate::linmot
