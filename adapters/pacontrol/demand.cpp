// Demands: what each order does to the demand of its axis, and what is published of it.
// In: orders with their acknowledgements, following errors, parameters. Out: a demand, or none.
// An order whose speed or ramp is not known for certain has no demand: 1910 tells its end all the same.
#include "adapters/pacontrol/demand.hpp"

#include <cmath>
#include <utility>

#include "adapters/pacontrol/wire_number.hpp"

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr double microsteps = 3200;  // of one motor revolution [L3098]
constexpr double full_step = microsteps / 200;
constexpr double steady = microsteps / 100;   // from one answer of 1915 to the next
constexpr double increments_per_unit = 1000;  // README, units
constexpr std::uint8_t refusals_limit = 3;    // 14h may also come from the mode that is just changing
constexpr Duration parameters_pause = std::chrono::seconds(1);
}  // namespace

// --- what the control acknowledged ---------------------------------------------------------------------------------------------------

void Demands::follow(const Sent& x, const Reply& reply, Instant now) {
    const Request& r = x.request;
    if (x.eot || x.purpose == Purpose::poll || x.purpose == Purpose::probe || x.purpose == Purpose::barrier) return;
    const bool of_parameter = r.code == code::put_axis_parameter;
    const std::uint32_t channel = of_parameter ? r.parameter >> 8 : r.parameter;
    if (of_parameter && channel >= 1 && channel <= drive_.axes.size()) {
        drive_.axes[channel - 1].demand.parameters = {};
        return;
    }
    if (reply.quit != 0) return;
    if (r.code == code::stop) {
        for (Axis& a : drive_.axes)
            brake(a, now);
        return;
    }
    const CommandInfo* c = command_info(r.code);
    if (!c || c->parameter != Takes::axis || channel < 1 || channel > drive_.axes.size()) return;
    Axis& a = drive_.axes[channel - 1];
    if (!a.used() || !is_online(drive_.mode)) return;
    // It may have been a late answer to something else: the order is on its way, and when it begins is not known.
    if (drive_.port.out_of_step()) return not_acknowledged(r);
    const double data = static_cast<double>(increments_of(real_of(r.data).value_or(0)));
    const double from = static_cast<double>(increments_of(number_of(reply).value_or(0)));
    switch (r.code) {
        case code::move_absolute:
        case code::move_absolute_wait:
            return ordered(a, from, data, now);
        case code::move_relative:
        case code::move_relative_wait:
            return ordered(a, from, from + data, now);
        case code::manual_absolute:  // at which speed the manual does not say (E-32)
        case code::manual_relative:
        case code::reference:
            return doubt(a);
        case code::stop_axis:
        case code::abort_move:
            return brake(a, now);
        case code::set_speed:
            a.speed = static_cast<std::int64_t>(data);
            a.demand.speed_doubted = false;
            // Only an EP takes it while the axis moves [L3488]; others have refused it.
            if (a.motion.active() && a.demand.computed.known() && !a.demand.computed.over(now) && data > 0)
                a.demand.computed.move(now, a.demand.target, data, a.demand.ramps);
            return;
        case code::set_acceleration:
            a.acceleration = static_cast<std::int64_t>(data);
            a.demand.ramp_doubted = false;
            return;
        case code::set_position:
        case code::position_null:
        case code::reference_here:
            // It stands, or it would have been refused (2Ah); the next position is the new one.
            a.demand.settle = true;
            a.demand.stands = !a.moves();
            a.demand.lag_due = true;
            return;
        default:
            return;
    }
}

void Demands::not_acknowledged(const Request& r) {
    const CommandInfo* c = command_info(r.code);
    if (r.code == code::stop) {
        for (Axis& a : drive_.axes)
            doubt(a);
    }
    if (!c || !c->online_only || c->parameter != Takes::axis || r.parameter < 1 || r.parameter > drive_.axes.size()) return;
    Axis& a = drive_.axes[r.parameter - 1];
    if (r.code == code::set_speed) a.demand.speed_doubted = true;
    if (r.code == code::set_acceleration) a.demand.ramp_doubted = true;
    doubt(a);
}

/// A motion begins at `start`. Without an override the axis parameters rule [6.1], and they can be read in home position alone.
void Demands::ordered(Axis& a, double start, double target, Instant now) {
    doubt(a);
    AxisDemand& m = a.demand;
    const auto parameter = [&](AxisDemand::Parameter which) -> double {
        return m.parameters[which].value.value_or(-1) * increments_per_unit;
    };
    const double speed = a.speed ? static_cast<double>(*a.speed) : parameter(AxisDemand::traverse_speed);
    const double ramp = a.acceleration ? static_cast<double>(*a.acceleration) : parameter(AxisDemand::acceleration);
    const double start_speed = parameter(AxisDemand::start_stop_speed);
    if (m.speed_doubted || m.ramp_doubted || !(speed > 0) || !(ramp > 0) || !(start_speed >= 0)) return;
    m.ramps = {ramp, ramp, start_speed};  // one acceleration for both ramps
    m.target = target;
    m.computed.rest(start);
    m.computed.move(now, target, speed, m.ramps);
}

DriveRates Demands::rates(const Axis& a) noexcept {
    const AxisDemand& m = a.demand;
    const auto parameter = [&](AxisDemand::Parameter which) { return increments_of(m.parameters[which].value.value_or(0)); };
    const std::int64_t speed = m.speed_doubted ? 0 : a.speed ? *a.speed : parameter(AxisDemand::traverse_speed);
    const std::int64_t ramp = m.ramp_doubted ? 0 : a.acceleration ? *a.acceleration : parameter(AxisDemand::acceleration);
    return {speed, ramp, ramp, ramp};
}

/// The ramp of the axis takes it to rest [L3756], and the place where it stands is taken over.
void Demands::brake(Axis& a, Instant now) {
    if (!a.used()) return;
    if (!a.demand.computed.known() || drive_.port.out_of_step()) return doubt(a);
    a.demand.computed.stop(now, a.demand.ramps);
    a.demand.settle = true;
    a.demand.stands = false;
}

void Demands::doubt(Axis& a) {
    a.demand.computed.forget();
    a.demand.settle = true;
    a.demand.stands = false;
}

void Demands::rest(Axis& a, std::int64_t position) {
    a.demand.computed.rest(static_cast<double>(position));
    a.demand.fresh = true;
    a.demand.settle = false;
}

// --- what the control says of its axes -----------------------------------------------------------------------------------------------

/// Whether orders of this gateway decide where the axis is. What happens while they do not is nobody's demand.
void Demands::guide(Axis& a) {
    const bool guided = a.on && drive_.mode == status::online && drive_.error == 0 && a.status != 4 && a.status != 8 &&
                        a.motion.kind != Motion::Kind::reference;
    if (guided == a.demand.guided) return;
    a.demand.guided = guided;
    a.demand.lag.reset();
    a.demand.lag_due = guided;
    a.demand.speed_doubted = a.demand.ramp_doubted = false;
    doubt(a);
}

void Demands::seen_running(Axis& a, Instant now) {
    a.demand.stands = false;
    if (!a.motion.active() && a.demand.computed.over(now)) doubt(a);  // it should stand: somebody else moves it
}

void Demands::seen_standing(Axis& a) {
    if (!a.demand.guided || !a.demand.settle || a.motion.active()) return;
    a.demand.stands = true;
    drive_.polls.soon_standing(a);
}

void Demands::show(Axis& a, Instant now) {
    guide(a);
    AxisFeedback& f = a.fb;
    const AxisDemand& m = a.demand;
    if (std::exchange(a.demand.fresh, false)) {
        a.demand.shown = std::llround(m.computed.at(now).position);
        a.demand.lag_pairs = std::exchange(a.demand.lag_new, false);
    }
    // While a held shaft falls behind, a counter of now with a 1915 of before would show it creeping on and falling back, cycle by cycle:
    // then the last pair stays until the next is whole.
    const bool by_drive = f.demand_source == DemandSource::drive && m.has_lag() && m.lag;
    if (by_drive && a.running && !m.lag_pairs && !m.lag_steady) return;
    a.demand.shown_at = a.counter_at;
    f.position = f.position_demand = a.counter;
    f.demand_source = DemandSource::none;
    if (!m.guided) return;
    if (a.demand.has_lag() && m.lag) {
        // 190C is the counter of the step motor, 1915 that counter less the encoder [L3098]: the shaft is behind the counter by so much.
        f.demand_source = DemandSource::drive;
        a.demand.shown_at = std::min(a.counter_at, m.lag_at);
        f.position = a.counter - following_error(a);
    } else if (m.computed.known()) {
        f.demand_source = DemandSource::computed;
        f.position_demand = m.shown;
    }
}

// --- 1915 ----------------------------------------------------------------------------------------------------------------------------

std::int64_t Demands::following_error(const Axis& a) noexcept {
    return increments_of(a.demand.lag.value_or(0) / microsteps * a.demand.parameters[AxisDemand::gear].value.value_or(0));
}

bool Demands::stands_behind(const Axis& a) noexcept {
    return a.demand.has_lag() && a.demand.lag && std::fabs(*a.demand.lag) > 2 * full_step;
}

void Demands::following_answered(Axis& a, double microsteps_behind, Instant now) {
    AxisDemand& m = a.demand;
    m.lag_at = now;
    m.lag_steady = !m.lag || std::fabs(microsteps_behind - *m.lag) <= steady;
    m.lag = microsteps_behind;
    m.lag_new = true;
    m.lag_due = false;
    m.lag_refusals = 0;
}

void Demands::following_refused(Axis& a, const Reply& reply) {
    if (reply.quit == quit::inadmissible && ++a.demand.lag_refusals < refusals_limit) return;
    a.demand.lag_missing = true;
    a.demand.lag.reset();
    drive_.polls.drop(code::following_error, &a);
}

// --- axis parameters -----------------------------------------------------------------------------------------------------------------

void Demands::parameters_may_have_changed() {
    drive_.parameters_at = {};  // an older refusal was the other mode's
    for (Axis& a : drive_.axes)
        a.demand.parameters = {};
}

void Demands::parameter_answered(Axis& a, std::uint8_t which, const Reply& reply, Instant now) {
    if (reply.quit == quit::inadmissible) {
        drive_.parameters_at = now + parameters_pause;  // the mode says home position and the control does not: later
        drive_.polls.drop(code::axis_parameter);
        return;
    }
    AxisDemand::Known& k = a.demand.parameters[which];
    k.read = true;
    k.value = reply.quit == 0 ? number_of(reply) : std::nullopt;
    // An axis that does not have a start-stop speed ramps from rest.
    if (which == AxisDemand::start_stop_speed && reply.quit != 0) k.value = 0;
}

}  // namespace axisgate::pacontrol
