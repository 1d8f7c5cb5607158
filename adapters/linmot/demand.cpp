// The calculation ends when the drive stops before the calculated end, because then something else has ended the motion.
#include "adapters/linmot/demand.hpp"

#include <cmath>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {

void AxisDemand::ordered(const Move& move, std::uint32_t v, std::uint32_t a, std::uint32_t d) noexcept {
    move_ = move;
    v_ = v, a_ = a, d_ = d;
}
void AxisDemand::ordered_stop(const Move& move, std::uint32_t d) noexcept {
    move_ = move;
    d_ = d;
}

std::uint32_t AxisDemand::deceleration() const noexcept { return d_ ? d_ : drive_.limits.deceleration.value_or(100'000); }

double AxisDemand::place(Instant now) const {
    const bool moves = demand_.known() && drive_.feedback.fb().moving;
    return moves ? demand_.at(now).position : drive_.feedback.status().position;
}

void AxisDemand::moves(Turn& t) {
    const DemandRamps ramps{.acceleration = a_ * 100.0 + (a_ == 0 ? 1 : 0), .deceleration = d_ * 100.0, .start_speed = 0};
    if (!demand_.known()) {
        if (drive_.feedback.fb().moving && drive_.feedback.fb().velocity != 0) return;
        rest(drive_.feedback.status().position);
    }
    const double v = v_ * 10.0;
    if (move_.kind == Move::Kind::velocity)
        return demand_.run(t.now, move_.target == 0 ? 0 : std::copysign(v, static_cast<double>(move_.target)), ramps);
    const double target = static_cast<double>(move_.target) + (move_.kind == Move::Kind::relative ? demand_.at(t.now).position : 0);
    demand_.move(t.now, target, v, ramps);
}

void AxisDemand::stops(Turn& t) {
    if (!demand_.known()) return;
    if (drive_.feedback.status().state() != state::enabled) return forget();  // it decelerates with an unknown ramp
    demand_.stop(t.now, {.acceleration = a_ * 100.0 + 1, .deceleration = deceleration() * 100.0, .start_speed = 0});
}

void AxisDemand::at_status(AxisFeedback& fb, Turn& t) {
    const Status& s = drive_.feedback.status();
    const bool held = s.state() >= state::enabled && s.state() != state::quick_stop;
    if (!held || s.state() == state::homing)
        forget();
    else if (!demand_.known() && !fb.moving)
        rest(s.position);
    else if (demand_.known() && !fb.moving && !drive_.motion.fresh() &&
             !demand_.over(t.now + drive_.bus.timing.reply_timeout + std::chrono::milliseconds(20)))
        rest(s.position);
    fb.demand_source = demand_.known() ? DemandSource::computed : DemandSource::none;
    fb.position_demand = demand_.known() ? std::llround(demand_.at(t.now).position) : fb.position;
}

}  // namespace axisgate::linmot
