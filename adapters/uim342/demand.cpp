// AxisDemand: the ramps that the drive runs, from the values in force.
// In: what the parts of the drive report. Out: the demand of the instant of each position.
// Never goes on where a value is not known, or something else than an order has moved the axis.
#include "adapters/uim342/demand.hpp"

#include <cmath>

#include "adapters/uim342/drive.hpp"

namespace axisgate::uim342 {

/// As the drive will run with the values in force; nothing: one of them is not known.
std::optional<DemandRamps> AxisDemand::ramps(std::int64_t speed) const noexcept {
    const auto& [ac, dc, ss, sd, time_ramps, il, tg] = drive_.known.ram;
    if (!ac || !dc || !ss || !time_ramps) return std::nullopt;
    DemandRamps r;
    r.start_speed = static_cast<double>(*ss);
    if (!*time_ramps) {
        if (*ac > 0) r.acceleration = static_cast<double>(*ac);
        if (*dc > 0) r.deceleration = static_cast<double>(*dc);
    } else if (const double step = static_cast<double>(speed) - r.start_speed; step > 0) {  // ms from the cut-in speed to the speed
        if (*ac > 0) r.acceleration = 1000 * step / static_cast<double>(*ac);
        if (*dc > 0) r.deceleration = 1000 * step / static_cast<double>(*dc);
    }
    return r;
}

void AxisDemand::forget() noexcept {
    demand_.forget();
    source_ = DemandSource::none;
}

void AxisDemand::rests(std::int64_t position) noexcept {
    if (!drive_.feedback.status().on) return forget();
    demand_.rest(static_cast<double>(position));
}

void AxisDemand::begins(const Motion& motion, Instant now) noexcept {
    using Kind = Motion::Kind;
    const std::int64_t speed = motion.kind == Kind::velocity ? std::llabs(motion.target) : motion.speed;
    const Feedback& feedback = drive_.feedback;
    const auto run = ramps(speed);
    if (motion.kind == Kind::none || motion.kind == Kind::unknown || !run || !feedback.status().on || !feedback.position_known())
        return forget();
    if (!feedback.fb().moving)
        demand_.rest(static_cast<double>(feedback.fb().position));  // the drive plans from where it is [L799], not from where it was sent
    if (!demand_.known()) return;                                   // and in motion from a speed that nobody knows
    if (motion.kind == Kind::velocity) return demand_.run(now, static_cast<double>(motion.target), *run);
    if (speed <= 0) return forget();
    double target = static_cast<double>(motion.target);
    if (motion.kind == Kind::relative) target += demand_.at(now).position;  // "adds to the current position" [L1476]
    demand_.move(now, target, static_cast<double>(speed), *run);
}

void AxisDemand::stops(bool soft, Instant now) noexcept {
    if (!demand_.known()) return;
    auto run = ramps(std::llabs(drive_.feedback.fb().velocity));
    const auto& sd = drive_.known.ram.sd;
    if (!run || (!soft && !sd)) return forget();
    if (!soft) run->deceleration = *sd > 0 ? static_cast<double>(*sd) : DemandRamps::at_once;
    demand_.stop(now, *run);
}

void AxisDemand::at_status(bool started_by_itself, Instant now) noexcept {
    const Feedback& feedback = drive_.feedback;
    if (!feedback.status().on || started_by_itself) return forget();
    if (feedback.fb().moving || !feedback.position_known()) return;
    // It stands before it should: a switch, a stall or somebody else has ended the motion. The answer to BG was this much late at most.
    if (demand_.known() && !demand_.over(now + drive_.bus.timing.reply_timeout)) forget();
}

void AxisDemand::at_position(Instant now) noexcept {
    const Feedback& feedback = drive_.feedback;
    const AxisFeedback& fb = feedback.fb();
    const auto& closed_loop = drive_.known.closed_loop;
    if (!feedback.status().on || !closed_loop || !feedback.status_known()) return forget();
    if (!*closed_loop) {
        source_ = DemandSource::open_loop;
        return;
    }
    // On, at rest, and held there: whatever has brought it here.
    if (!demand_.known() && !fb.moving && !drive_.homing.searching() && fb.velocity == 0) demand_.rest(static_cast<double>(fb.position));
    if (!demand_.known()) return forget();
    source_ = DemandSource::computed;
    position_ = std::llround(demand_.at(now).position);
}

void AxisDemand::show(AxisFeedback& fb) const noexcept {
    fb.demand_source = source_;
    fb.position_demand = position_;
}

}  // namespace axisgate::uim342
