// Drive, part demand: where each axis should be: by 1915 where the control tells it, else by the order that it acknowledged.
// In: acknowledgements of orders, 1911, positions, axis parameters. Out: demand_source and position_demand of the feedback.
// Never guesses: whatever else may have moved the axis leaves its demand unknown until it stands, and then it is where it stands.
#include <algorithm>
#include <cmath>
#include <utility>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr double microsteps = 3200;  // of one motor revolution [L3098]
constexpr double full_step = microsteps / 200;
constexpr double steady = microsteps / 100;   // from one answer of 1915 to the next
constexpr double increments_per_unit = 1000;  // README, units
constexpr std::size_t parameters_per_cycle = 4;
constexpr std::uint8_t refusals_limit = 3;  // 14h may also come from the mode that is just changing
constexpr Duration parameters_pause = std::chrono::seconds(1);
}  // namespace

// --- what the control acknowledged ---------------------------------------------------------------------------------------------------

/// Every acknowledged command passes here, whoever asked for it: verb, action or native text.
void Drive::follow(const Exchange& x, const Reply& reply, Turn& t) {
    const Request& r = x.request;
    if (x.eot || x.purpose == Purpose::poll || x.purpose == Purpose::probe || x.purpose == Purpose::barrier) return;
    const bool of_parameter = r.code == code::put_axis_parameter;
    const std::uint32_t channel = of_parameter ? r.parameter >> 8 : r.parameter;
    if (of_parameter && channel >= 1 && channel <= axes_.size()) {
        axes_[channel - 1].aim.parameters = {};
        return;
    }
    if (reply.quit != 0) return;
    if (r.code == code::stop) {
        for (Axis& a : axes_)
            brake(a, t);
        return;
    }
    const CommandInfo* c = command_info(r.code);
    if (!c || c->parameter != Takes::axis || channel < 1 || channel > axes_.size()) return;
    Axis& a = axes_[channel - 1];
    if (a.id == no_axis || !is_online(mode_)) return;
    // It may have been a late answer to something else: the order is on its way, and when it begins is not known.
    if (out_of_step_) return not_acknowledged(r);
    const double data = static_cast<double>(increments_of(real_of(r.data).value_or(0)));
    const double said = static_cast<double>(increments_of(number_of(reply).value_or(0)));
    switch (r.code) {
        case code::move_absolute:
        case code::move_absolute_wait:
            return ordered(a, said, data, t);
        case code::move_relative:
        case code::move_relative_wait:
            return ordered(a, said, said + data, t);
        case code::manual_absolute:  // at which speed the manual does not say (E-32)
        case code::manual_relative:
        case code::reference:
            return doubt(a);
        case code::stop_axis:
        case code::abort_move:
            return brake(a, t);
        case code::set_speed:
            a.speed = static_cast<std::int64_t>(data);
            a.aim.speed_doubted = false;
            // Only an EP takes it while the axis moves [L3488]; others have refused it.
            if (a.motion.active() && a.aim.demand.known() && !a.aim.demand.over(t.now) && data > 0)
                a.aim.demand.move(t.now, a.aim.target, data, a.aim.ramps);
            return;
        case code::set_acceleration:
            a.acceleration = static_cast<std::int64_t>(data);
            a.aim.ramp_doubted = false;
            return;
        case code::set_position:
        case code::position_null:
        case code::reference_here:
            // It stands, or it would have been refused (2Ah); the next position is the new one.
            a.aim.settle = true;
            a.aim.stands = !a.running && !a.motion.active();
            a.aim.lag_due = true;
            return;
        default:
            return;
    }
}

/// Sent, and whether it is carried out is not known.
void Drive::not_acknowledged(const Request& r) {
    const CommandInfo* c = command_info(r.code);
    if (r.code == code::stop) {
        for (Axis& a : axes_)
            doubt(a);
    }
    if (!c || !c->online_only || c->parameter != Takes::axis || r.parameter < 1 || r.parameter > axes_.size()) return;
    Axis& a = axes_[r.parameter - 1];
    if (r.code == code::set_speed) a.aim.speed_doubted = true;
    if (r.code == code::set_acceleration) a.aim.ramp_doubted = true;
    doubt(a);
}

/// A motion begins at `start`. Without an override the axis parameters rule [6.1], and they can be read in home position alone.
void Drive::ordered(Axis& a, double start, double target, Turn& t) {
    doubt(a);
    Aim& m = a.aim;
    const auto parameter = [&](Aim::Parameter which) -> double { return m.parameters[which].value.value_or(-1) * increments_per_unit; };
    const double speed = a.speed ? static_cast<double>(*a.speed) : parameter(Aim::traverse_speed);
    const double ramp = a.acceleration ? static_cast<double>(*a.acceleration) : parameter(Aim::acceleration);
    const double start_speed = parameter(Aim::start_stop_speed);
    if (m.speed_doubted || m.ramp_doubted || !(speed > 0) || !(ramp > 0) || !(start_speed >= 0)) return;
    m.ramps = {ramp, ramp, start_speed};  // one acceleration for both ramps
    m.target = target;
    m.demand.rest(start);
    m.demand.move(t.now, target, speed, m.ramps);
}

/// The ramp of the axis takes it to rest [L3756], and the place where it stands is taken over.
void Drive::brake(Axis& a, Turn& t) {
    if (a.id == no_axis) return;
    if (!a.aim.demand.known() || out_of_step_) return doubt(a);
    a.aim.demand.stop(t.now, a.aim.ramps);
    a.aim.settle = true;
    a.aim.stands = false;
}

void Drive::doubt(Axis& a) {
    a.aim.demand.forget();
    a.aim.settle = true;
    a.aim.stands = false;
}

void Drive::rest(Axis& a, std::int64_t position) {
    a.aim.demand.rest(static_cast<double>(position));
    a.aim.fresh = true;
    a.aim.settle = false;
}

// --- what the control says of its axes -----------------------------------------------------------------------------------------------

/// Whether orders of this gateway decide where the axis is. What happens while they do not is nobody's demand.
void Drive::guide(Axis& a) {
    const bool guided =
        a.on && mode_ == status::online && error_ == 0 && a.status != 4 && a.status != 8 && a.motion.kind != Motion::Kind::reference;
    if (guided == a.aim.guided) return;
    a.aim.guided = guided;
    a.aim.lag.reset();
    a.aim.lag_due = guided;
    a.aim.speed_doubted = a.aim.ramp_doubted = false;
    doubt(a);
}

void Drive::seen_running(Axis& a, Turn& t) {
    a.aim.stands = false;
    if (!a.motion.active() && a.aim.demand.over(t.now)) doubt(a);  // it should stand: somebody else moves it
}

void Drive::seen_standing(Axis& a) {
    if (!a.aim.guided || !a.aim.settle || a.motion.active()) return;
    a.aim.stands = true;
    poll_standing(a);
}

/// Source and demand that belong to the position that was told last.
void Drive::show_demand(Axis& a, Instant now) {
    guide(a);
    AxisFeedback& f = a.fb;
    const Aim& m = a.aim;
    if (std::exchange(a.aim.fresh, false)) {
        a.aim.shown = std::llround(m.demand.at(now).position);
        a.aim.lag_pairs = std::exchange(a.aim.lag_new, false);
    }
    // While a held shaft falls behind, a counter of now with a 1915 of before would show it creeping on and falling back, cycle by cycle:
    // then the last pair stays until the next is whole.
    const bool told = f.demand_source == DemandSource::drive && m.guided && tells_following_error(a) && m.lag;
    if (told && a.running && !m.lag_pairs && !m.lag_steady) return;
    a.aim.shown_at = a.counter_at;
    f.position = f.position_demand = a.counter;
    f.demand_source = DemandSource::none;
    if (!m.guided) return;
    if (tells_following_error(a) && m.lag) {
        // 190C is the counter of the step motor, 1915 that counter less the encoder [L3098]: the shaft is behind the counter by so much.
        f.demand_source = DemandSource::drive;
        a.aim.shown_at = std::min(a.counter_at, m.lag_at);
        f.position = a.counter - following_error(a);
    } else if (m.demand.known()) {
        f.demand_source = DemandSource::computed;
        f.position_demand = m.shown;
    }
}

// --- 1915 ----------------------------------------------------------------------------------------------------------------------------

/// Microsteps mean something once the way of one revolution is known.
bool Drive::tells_following_error(const Axis& a) noexcept {
    return a.aim.guided && !a.aim.lag_missing && a.aim.parameters[Aim::gear].value.value_or(0) > 0;
}

std::int64_t Drive::following_error(const Axis& a) noexcept {
    return increments_of(a.aim.lag.value_or(0) / microsteps * a.aim.parameters[Aim::gear].value.value_or(0));
}

bool Drive::stands_behind(const Axis& a) noexcept { return tells_following_error(a) && a.aim.lag && std::fabs(*a.aim.lag) > 2 * full_step; }

void Drive::following_answered(Axis& a, double microsteps_behind, Turn& t) {
    Aim& m = a.aim;
    m.lag_at = t.now;
    m.lag_steady = !m.lag || std::fabs(microsteps_behind - *m.lag) <= steady;
    m.lag = microsteps_behind;
    m.lag_new = true;
    m.lag_due = false;
    m.lag_refusals = 0;
}

void Drive::following_refused(Axis& a, const Reply& reply) {
    if (reply.quit == quit::inadmissible && ++a.aim.lag_refusals < refusals_limit) return;
    a.aim.lag_missing = true;
    a.aim.lag.reset();
    std::erase_if(polls_, [&](const Poll& p) { return p.kind == PollKind::following && p.axis == place(a); });
}

// --- axis parameters -----------------------------------------------------------------------------------------------------------------

bool Drive::parameters_readable(Instant now) const noexcept { return is_home(mode_) && now >= parameters_at_; }

void Drive::parameters_may_have_changed() {
    parameters_at_ = {};  // an older refusal was the other mode's
    for (Axis& a : axes_)
        a.aim.parameters = {};
}

/// A few at a time, in home position, where nothing moves and nothing else is urgent. Those that are known are looked at again in the
/// slow round (plan_cycle): they can be changed at the control.
void Drive::plan_parameters(Turn& t) {
    if (!parameters_readable(t.now)) return;
    std::size_t planned = 0;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        if (axes_[i].id == no_axis || axes_[i].missing) continue;
        for (std::uint8_t k = 0; k < Aim::numbers.size(); ++k) {
            if (axes_[i].aim.parameters[k].read) continue;
            polls_.push_back({PollKind::parameter, i, k});
            if (++planned == parameters_per_cycle) return;
        }
    }
}

void Drive::parameter_answered(Axis& a, std::uint8_t which, const Reply& reply, Turn& t) {
    if (reply.quit == quit::inadmissible) {
        parameters_at_ = t.now + parameters_pause;  // the mode says home position and the control does not: later
        std::erase_if(polls_, [](const Poll& p) { return p.kind == PollKind::parameter; });
        return;
    }
    Aim::Known& k = a.aim.parameters[which];
    k.read = true;
    k.value = reply.quit == 0 ? number_of(reply) : std::nullopt;
    // An axis that does not have a start-stop speed ramps from rest.
    if (which == Aim::start_stop_speed && reply.quit != 0) k.value = 0;
}

}  // namespace axisgate::pacontrol
