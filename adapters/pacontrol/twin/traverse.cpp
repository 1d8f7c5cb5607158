// The traverse task of one axis, its events in their order.
// In: motions, time. Out: positions, errors. Never steps: every event has its closed-form instant.
#include "adapters/pacontrol/twin/traverse.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace axisgate::pacontrol::twin {
namespace {
constexpr double creep_way = 0.2;        // AE, off the switch and back to its edge
constexpr double creep_way_forced = 10;  // AE, the most it creeps to leave a switch that a hand holds
constexpr double place_limit = 1e9;      // AE: positions stay numbers of 7 digits that mean something
}  // namespace

std::uint16_t Traverse::may_start(const Motion& m, Instant t) const {
    if (!std::isfinite(m.target) || std::abs(m.target) > place_limit) return quit::outside_range;
    if (!(m.speed > 0) || !(m.acceleration > 0)) return quit::value;
    if (!m.free && (m.target < area_min() || m.target > area_max())) return quit::outside_range;
    const double way = m.target - shaft_.position(t);
    const double steps = std::abs(way) / std::max(static_cast<double>(p_[ap::gear]), 1e-9) * static_cast<double>(p_[ap::motor_steps]);
    if (steps > 2147483647.0) return quit::path_too_long;
    if (shaft_.running()) return quit::moves;
    if (!m.free && !state_.referenced) return quit::no_reference;
    if (state_.fault != 0 || state_.measuring || !state_.outside.power_pack) return quit::not_ready;
    if (state_.off || !state_.enabled()) return quit::switched_off;
    if (state_.displaced) return quit::displaced;
    if (m.limits_monitored && ((way > 0 && switches_.limit(true)) || (way < 0 && switches_.limit(false)))) return quit::limit_switch;
    return quit::ok;
}

void Traverse::run(const Path& path, Instant t) {
    shaft_.run(path);
    if (path.end() <= t) path_ended(t);
}

void Traverse::start(const Motion& m, Instant t) {
    const double here = shaft_.position(t);
    shaft_.seen(t);
    motion_ = m;
    target_ = m.target;
    task_ = m.task;
    phase_ = Phase::none;
    state_.power = AxisPower::on;
    braking_ = interrupted_ = want_interrupt_ = stopped_ = stopped_by_condition_ = false;
    ended_with_ = 0;
    watchdog_ = m.task == Task::manual ? t + model_.watchdog : never;
    const Instant begins = t + model_.motion_start;
    run(Path::to(here, m.target, 0, m.speed, static_cast<double>(p_[ap::start_stop_speed]), m.acceleration, begins), t);
}

std::uint16_t Traverse::may_reference() const {
    if (shaft_.running()) return quit::moves;
    if (state_.fault != 0 || state_.measuring || !state_.outside.power_pack) return quit::not_ready;
    if (state_.off || !state_.enabled()) return quit::switched_off;
    if (state_.displaced) return quit::displaced;
    return quit::ok;
}

/// Seeks the edge of the home switch, leaves it at creep speed and creeps back to it.
void Traverse::start_reference(Instant t) {
    motion_ = {};
    motion_.task = task_ = Task::reference;
    motion_.free = true;
    motion_.acceleration = static_cast<double>(p_[ap::acceleration]);
    braking_ = interrupted_ = want_interrupt_ = stopped_ = stopped_by_condition_ = false;
    ended_with_ = 0;
    watchdog_ = never;
    state_.referenced = false;
    state_.changed = true;
    state_.power = AxisPower::on;
    const bool on_switch = switches_.home();
    phase_ = on_switch ? Phase::creep_out : Phase::seek;
    const double edge = shaft_.offset() + switches_.edge_below(shaft_.rest_place());
    target_ = edge;
    const double out = switches_.home_by_hand() ? shaft_.rest() + creep_way_forced : edge + creep_way + model_.hysteresis;
    run(Path::to(shaft_.rest(), on_switch ? out : edge, 0, static_cast<double>(p_[on_switch ? ap::creep_speed : ap::reference_speed]), 0,
                 motion_.acceleration, t + model_.motion_start),
        t);
}

void Traverse::next_phase(Instant t) {
    const double creep = static_cast<double>(p_[ap::creep_speed]);
    const double edge = target_;
    switch (phase_) {
        case Phase::seek:
            phase_ = Phase::creep_out;
            run(Path::to(shaft_.rest(), shaft_.rest() + (switches_.home_by_hand() ? creep_way_forced : creep_way + model_.hysteresis), 0,
                         creep, 0, motion_.acceleration, t),
                t);
            return;
        case Phase::creep_out:
            if (switches_.home_by_hand()) {
                abort_with(error::no_reference, quit::not_executable, t);  // it never left the switch
                return;
            }
            phase_ = Phase::creep_back;
            run(Path::to(shaft_.rest(), braking_ ? shaft_.rest() : edge, 0, creep, 0, motion_.acceleration, t), t);
            return;
        default:
            break;
    }
    // The counter counts from the zero point; the switch lies where parameter 21h says (0: on it) [L2302].
    const double counter = static_cast<double>(p_[ap::zero_to_switch]);
    shaft_.zero(counter);
    state_.shift = 0;
    target_ = counter;
    state_.referenced = true;
    phase_ = Phase::none;
    stand();
}

/// The end of a path: of a phase, of the motion, of a ramp.
void Traverse::path_ended(Instant t) {
    shaft_.arrive(t);
    if (task_ == Task::reference && !braking_) return next_phase(t);
    if (braking_) {
        stopped_ = true;
        interrupted_ = want_interrupt_;
        if (state_.off) {  // from here on a displacement counts
            state_.off_position = shaft_.rest();
            state_.off_place = shaft_.rest_place();
        }
        if (interrupted_) state_.power = state_.power == AxisPower::on ? AxisPower::halt : state_.power;
    }
    stand();
}

void Traverse::stand() noexcept {
    braking_ = want_interrupt_ = false;
    watchdog_ = never;
    state_.changed = true;
    if (!interrupted_) {
        task_ = Task::none;
        phase_ = Phase::none;
    }
}

void Traverse::drop(Instant t) {
    shaft_.freeze(t);
    braking_ = interrupted_ = want_interrupt_ = false;
    stand();
}

void Traverse::boot() noexcept {
    braking_ = interrupted_ = want_interrupt_ = stopped_ = stopped_by_condition_ = false;
    task_ = Task::none;
    phase_ = Phase::none;
    ended_with_ = 0;
    renamed();
}

void Traverse::ramp_down(Instant t) {
    if (!shaft_.running()) return;
    const double v = shaft_.path().velocity(t);
    const double here = shaft_.path().position(t);
    braking_ = true;
    watchdog_ = never;
    run(Path::halt(here, v < 0 ? -1 : 1, std::abs(v), static_cast<double>(p_[ap::start_stop_speed]), motion_.acceleration, t), t);
}

void Traverse::finish(Instant t) {
    want_interrupt_ = false;
    interrupted_ = false;
    if (!shaft_.running()) {
        task_ = Task::none;
        if (state_.power == AxisPower::halt && !state_.off) state_.power = AxisPower::on;
        return;
    }
    if (!braking_) ramp_down(t);
}

void Traverse::finish_by_condition(Instant t) {
    if (!shaft_.running() || braking_) return;
    stopped_by_condition_ = true;
    finish(t);
}

void Traverse::skipped_by_condition() noexcept {
    stopped_by_condition_ = true;
    stopped_ = true;
    ended_with_ = 0;
}

void Traverse::interrupt(Instant t) {
    if (!shaft_.running() || braking_) return;
    // A reference run and a move of the manual kind end here; they have nothing to go on with.
    want_interrupt_ = task_ == Task::position;
    ramp_down(t);
}

void Traverse::resume(Instant t) {
    if (!interrupted_ || shaft_.running()) return;
    if (state_.power == AxisPower::halt) state_.power = AxisPower::on;
    if (may_start(motion_, t) != quit::ok) return;
    const Motion again = motion_;
    start(again, t);
}

void Traverse::renew(Instant t) noexcept {
    if (shaft_.running() && !braking_ && task_ == Task::manual) watchdog_ = t + model_.watchdog;
}

void Traverse::change_speed(double speed, Instant t) {
    if (!shaft_.running() || braking_ || task_ == Task::reference) return;
    motion_.speed = speed;
    const double v = std::abs(shaft_.path().velocity(t));
    run(Path::to(shaft_.path().position(t), motion_.target, v, speed, static_cast<double>(p_[ap::start_stop_speed]), motion_.acceleration,
                 t),
        t);
}

/// Stands at once where it is, with an error.
void Traverse::abort_with(std::uint16_t number, std::uint16_t code, Instant t) {
    shaft_.note_lag(t);
    shaft_.freeze(t);
    shaft_.keep_lost();
    if (model_.ep && number == error::following_error) {  // the encoder knows where the shaft is
        shaft_.take_over();
        shaft_.set_extra_lag(0);
    }
    braking_ = interrupted_ = want_interrupt_ = false;
    stopped_ = true;
    ended_with_ = code;
    if (state_.fault == 0) state_.raised = number;
    state_.fault = state_.fault == 0 ? number : state_.fault;
    stand();
}

void Traverse::hit_limit(bool positive, Instant t) {
    abort_with(positive ? error::limit_positive : error::limit_negative, quit::limit_switch, t);
}

void Traverse::limit_changed(Instant t) {
    if (!shaft_.running() || !motion_.limits_monitored || task_ == Task::reference) return;
    const double v = shaft_.path().velocity(t);
    if (v > 0 && switches_.limit(true)) hit_limit(true, t);
    if (v < 0 && switches_.limit(false)) hit_limit(false, t);
}

void Traverse::home_changed(bool active, Instant t) {
    if (!shaft_.running() || task_ != Task::reference || braking_) return;
    if ((phase_ == Phase::seek && active) || (phase_ == Phase::creep_out && !active)) {
        // The switch changed under way: that is the edge.
        shaft_.freeze(t);
        if (phase_ == Phase::creep_out) phase_ = Phase::creep_back;
        next_phase(t);
    }
}

double Traverse::most_lag() const noexcept { return p_[ap::rotation_monitoring] == 0 ? 0 : static_cast<double>(p_[ap::following_error]); }

Instant Traverse::lag_exceeded() const noexcept { return most_lag() <= 0 ? never : shaft_.lag_passes(most_lag()); }

/// While switches are monitored. Those that are exchanged in the parameters stop nothing.
Instant Traverse::limit_passed() const noexcept {
    if (!shaft_.running() || shaft_.held() || !motion_.limits_monitored || task_ == Task::reference || p_[ap::limits_exchanged] != 0)
        return never;
    return switches_.passed();
}

Instant Traverse::deadline() const noexcept {
    const Instant lag = most_lag() > 0 && (shaft_.running() || state_.holds()) ? shaft_.lag_due() : never;
    const Instant standing = std::min(lag, state_.on_at);
    if (!shaft_.running()) return standing;
    return std::min({shaft_.path().end(), watchdog_, lag_exceeded(), limit_passed(), standing});
}

/// Power goes as soon as the ramp to standstill is over.
void Traverse::follow(Instant t) {
    const Instant exceeded = shaft_.follow(t, shaft_.running() || state_.holds(), state_.fault == 0 ? most_lag() : 0);
    lagged_ = std::min(lagged_, exceeded);
}

void Traverse::advance(Instant t) {
    if (lagged_ != never) {
        shaft_.seen(t);
        abort_with(error::following_error, quit::not_ready, std::exchange(lagged_, never));
    }
    if (shaft_.running()) shaft_.note_lag(t);
    for (int rounds = 0; shaft_.running() && rounds < 16; ++rounds) {  // a motion has at most a handful of events at one instant
        const Instant exceeded = lag_exceeded(), passed = limit_passed();
        if (passed <= t && passed <= shaft_.path().end() && passed <= exceeded) {
            const bool up = shaft_.path().direction() > 0;
            shaft_.seen(passed);
            hit_limit(up, passed);
            if (model_.revolution > 0) shaft_.count((up ? 1 : -1) * model_.revolution * switch_share / 100);  // stands on it
        } else if (exceeded <= t && exceeded <= shaft_.path().end()) {
            abort_with(error::following_error, quit::not_ready, exceeded);
        } else if (watchdog_ <= t && watchdog_ < shaft_.path().end()) {
            finish(watchdog_);
        } else if (shaft_.path().end() <= t) {
            path_ended(shaft_.path().end());
        } else {
            break;
        }
    }
    shaft_.seen(t);
    switches_.follow();
}

}  // namespace axisgate::pacontrol::twin
