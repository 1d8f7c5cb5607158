// Drive, part demand: where the axis should be, worked out from the orders that the drive acknowledged (brief ramps: cut-in speed, AC, DC,
// SD). In: the beginnings and ends of motions, statuses, positions. Out: demand and its source in the feedback. Never told by the drive:
// MS[1] has the position alone and DV[4] the end of the motion. In open loop the position is itself a count of steps.
#include <cmath>

#include "adapters/uim342/drive.hpp"

namespace axisgate::uim342 {

/// As the drive will run with the values in force; nothing: one of them is not known.
std::optional<DemandRamps> Drive::demand_ramps(std::int64_t speed) const noexcept {
    if (!ac_ || !dc_ || !ss_ || !time_ramps_) return std::nullopt;
    DemandRamps r;
    r.start_speed = static_cast<double>(*ss_);
    if (!*time_ramps_) {
        if (*ac_ > 0) r.acceleration = static_cast<double>(*ac_);
        if (*dc_ > 0) r.deceleration = static_cast<double>(*dc_);
    } else if (const double step = static_cast<double>(speed) - r.start_speed; step > 0) {  // ms from the cut-in speed to the speed
        if (*ac_ > 0) r.acceleration = 1000 * step / static_cast<double>(*ac_);
        if (*dc_ > 0) r.deceleration = 1000 * step / static_cast<double>(*dc_);
    }
    return r;
}

void Drive::forget_demand() noexcept {
    demand_.forget();
    fb_.demand_source = DemandSource::none;
}

void Drive::demand_rests(std::int64_t position) noexcept {
    if (!status_.on) return forget_demand();
    demand_.rest(static_cast<double>(position));
}

/// BG has been acknowledged. Ack and later positions come with the same delay from the drive, so their difference is free of it.
void Drive::demand_begins(const Motion& motion, Instant now) noexcept {
    using Kind = Motion::Kind;
    const std::int64_t speed = motion.kind == Kind::velocity ? std::llabs(motion.target) : motion.speed;
    const auto ramps = demand_ramps(speed);
    if (motion.kind == Kind::none || motion.kind == Kind::unknown || !ramps || !status_.on || !position_known_) return forget_demand();
    if (!fb_.moving)
        demand_.rest(static_cast<double>(fb_.position));  // the drive plans from where it is [L799], not from where it was sent
    if (!demand_.known()) return;                         // and in motion from a speed that nobody knows
    if (motion.kind == Kind::velocity) return demand_.run(now, static_cast<double>(motion.target), *ramps);
    if (speed <= 0) return forget_demand();
    double target = static_cast<double>(motion.target);
    if (motion.kind == Kind::relative) target += demand_.at(now).position;  // "adds to the current position" [L1476]
    demand_.move(now, target, static_cast<double>(speed), *ramps);
}

/// A halt by JV = 0 runs down with DC, ST with SD; SD = 0 is no ramp.
void Drive::demand_stops(bool soft, Instant now) noexcept {
    if (!demand_.known()) return;
    auto ramps = demand_ramps(std::llabs(fb_.velocity));
    if (!ramps || (!soft && !sd_)) return forget_demand();
    if (!soft) ramps->deceleration = *sd_ > 0 ? static_cast<double>(*sd_) : DemandRamps::at_once;
    demand_.stop(now, *ramps);
}

/// `started_by_itself`: it stood, nothing was ordered, and now it moves.
void Drive::demand_at_status(bool started_by_itself, Instant now) noexcept {
    if (!status_.on || started_by_itself) return forget_demand();
    if (fb_.moving || !position_known_) return;
    // It stands before it should: a switch, a stall or somebody else has ended the motion. The answer to BG was this much late at most.
    if (demand_.known() && !demand_.over(now + bus_.timing.reply_timeout)) forget_demand();
}

/// Called with each position: it and the demand belong to one instant.
void Drive::demand_at_position(Instant now) noexcept {
    if (!status_.on || !closed_loop_ || !status_known_) return forget_demand();
    if (!*closed_loop_) {
        fb_.demand_source = DemandSource::open_loop;
        return;
    }
    // On, at rest, and held there: whatever has brought it here.
    if (!demand_.known() && !fb_.moving && !searching() && fb_.velocity == 0) demand_.rest(static_cast<double>(fb_.position));
    if (!demand_.known()) return forget_demand();
    fb_.demand_source = DemandSource::computed;
    fb_.position_demand = std::llround(demand_.at(now).position);
}

}  // namespace axisgate::uim342
