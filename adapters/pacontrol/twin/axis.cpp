// Motions of one axis: start, end, interruption, reference run, watchdog, what stops it by itself.
// In: motions, time. Out: positions, errors. Never steps: every event has its closed-form instant.
#include "adapters/pacontrol/twin/axis.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::pacontrol::twin {
namespace {
constexpr double creep_way = 0.2;        // AE, off the switch and back to its edge
constexpr double creep_way_forced = 10;  // AE, the most it creeps to leave a switch that a hand holds
constexpr double place_limit = 1e9;      // AE: positions stay numbers of 7 digits that mean something
constexpr double edge_slack = 1e-9;      // of a turn: a rotary axis that stands on the edge is off its switch
}  // namespace

double Axis::position(Instant t) const noexcept { return running_ ? path_.position(t) : rest_; }
double Axis::velocity(Instant t) const noexcept { return running_ && !held_ ? path_.velocity(t) : 0; }

double Axis::lag(Instant t) const noexcept {
    return lost_ + (held_ ? position(t) - held_at_ : 0) + extra_lag_ + load_ * velocity(t) * 0.001;
}
double Axis::greatest_lag(Instant t) const noexcept { return std::max(greatest_lag_, std::abs(lag(t))); }
void Axis::note_lag(Instant t) noexcept { greatest_lag_ = greatest_lag(t); }
double Axis::shaft(Instant t) const noexcept { return position(t) - origin_ - lost_ - (held_ ? position(t) - held_at_ : 0); }

std::uint8_t Axis::status() const noexcept {
    if (measuring_) return 8;
    if (fault_ != 0) return 4;
    if (running_) return 1;
    return stopped_ ? 2 : 0;
}

std::uint16_t Axis::may_start(const Motion& m, Instant t) const {
    if (!std::isfinite(m.target) || std::abs(m.target) > place_limit) return quit::outside_range;
    if (!(m.speed > 0) || !(m.acceleration > 0)) return quit::value;
    if (!m.free && (m.target < area_min() || m.target > area_max())) return quit::outside_range;
    const double way = m.target - position(t);
    const double steps = std::abs(way) / std::max(static_cast<double>(p_[ap::gear]), 1e-9) * static_cast<double>(p_[ap::motor_steps]);
    if (steps > 2147483647.0) return quit::path_too_long;
    if (running_) return quit::moves;
    if (!m.free && !referenced_) return quit::no_reference;
    if (fault_ != 0 || measuring_ || !power_pack_) return quit::not_ready;
    if (off_ || !enabled()) return quit::switched_off;
    if (displaced_) return quit::displaced;
    if (m.limits_monitored && ((way > 0 && limit_actuated(true)) || (way < 0 && limit_actuated(false)))) return quit::limit_switch;
    return quit::ok;
}

void Axis::run(const Path& path, Instant t) {
    path_ = path;
    running_ = true;
    if (path_.end() <= t) path_ended(t);
}

void Axis::start(const Motion& m, Instant t) {
    const double here = position(t);
    now_ = std::max(now_, t);
    motion_ = m;
    target_ = m.target;
    task_ = m.task;
    phase_ = Phase::none;
    power_ = AxisPower::on;
    braking_ = interrupted_ = want_interrupt_ = stopped_ = stopped_by_condition_ = false;
    ended_with_ = 0;
    watchdog_ = m.task == Task::manual ? t + model_.watchdog : never;
    run(Path::to(here, m.target, 0, m.speed, static_cast<double>(p_[ap::start_stop_speed]), m.acceleration, t), t);
}

std::uint16_t Axis::may_reference() const {
    if (running_) return quit::moves;
    if (fault_ != 0 || measuring_ || !power_pack_) return quit::not_ready;
    if (off_ || !enabled()) return quit::switched_off;
    if (displaced_) return quit::displaced;
    return quit::ok;
}

bool Axis::home_active() const noexcept {
    if (home_forced_) return true;
    return model_.revolution > 0 ? switch_at_shaft(false) : rest_ - origin_ - lost_ < 0;
}

/// The edge of the home switch from which a reference run counts: at shaft position 0; of a rotary axis the whole turn at or below, where
/// its switch is the reference switch first of all [L834]; on the switch the whole turn above.
double Axis::edge_below(double shaft) const noexcept {
    if (model_.revolution <= 0) return 0;
    return (std::floor(shaft / model_.revolution + edge_slack) + (switch_at_shaft(false) ? 1 : 0)) * model_.revolution;
}

/// Seeks the edge of the home switch, leaves it at creep speed and creeps back to it.
void Axis::start_reference(Instant t) {
    motion_ = {};
    motion_.task = task_ = Task::reference;
    motion_.free = true;
    motion_.acceleration = static_cast<double>(p_[ap::acceleration]);
    braking_ = interrupted_ = want_interrupt_ = stopped_ = stopped_by_condition_ = false;
    ended_with_ = 0;
    watchdog_ = never;
    referenced_ = false;
    changed_ = true;
    power_ = AxisPower::on;
    rest_ = position(t);
    const bool on_switch = home_active();
    phase_ = on_switch ? Phase::creep_out : Phase::seek;
    const double edge = origin_ + lost_ + edge_below(rest_ - origin_ - lost_);
    target_ = edge;
    const double out = home_forced_ ? rest_ + creep_way_forced : edge + creep_way;
    run(Path::to(rest_, on_switch ? out : edge, 0, static_cast<double>(p_[on_switch ? ap::creep_speed : ap::reference_speed]), 0,
                 motion_.acceleration, t),
        t);
}

void Axis::next_phase(Instant t) {
    const double creep = static_cast<double>(p_[ap::creep_speed]);
    const double edge = target_;
    switch (phase_) {
        case Phase::seek:
            phase_ = Phase::creep_out;
            run(Path::to(rest_, rest_ + (home_forced_ ? creep_way_forced : creep_way), 0, creep, 0, motion_.acceleration, t), t);
            return;
        case Phase::creep_out:
            if (home_forced_) {
                abort_with(error::no_reference, quit::not_executable, t);  // it never left the switch
                return;
            }
            phase_ = Phase::creep_back;
            run(Path::to(rest_, braking_ ? rest_ : edge, 0, creep, 0, motion_.acceleration, t), t);
            return;
        default:
            break;
    }
    // The counter counts from the zero point; the switch lies where parameter 21h says (0: on it) [L2302].
    const double counter = static_cast<double>(p_[ap::zero_to_switch]);
    origin_ += counter - rest_;
    rest_ = counter;
    lost_ = 0;
    shift_ = 0;
    target_ = rest_;
    referenced_ = true;
    phase_ = Phase::none;
    stand(t);
}

/// The end of a path: of a phase, of the motion, of a ramp.
void Axis::path_ended(Instant t) {
    note_lag(t);
    greatest_lag_ = std::max(greatest_lag_, load_ * path_.peak() * 0.001);
    rest_ = path_.last();
    running_ = false;
    if (held_) {
        lost_ += rest_ - held_at_;
        held_at_ = rest_;
    }
    if (task_ == Task::reference && !braking_) return next_phase(t);
    if (braking_) {
        stopped_ = true;
        interrupted_ = want_interrupt_;
        if (off_) {  // from here on a displacement counts
            off_position_ = rest_;
            off_shaft_ = rest_ - origin_ - lost_;
        }
        if (interrupted_) power_ = power_ == AxisPower::on ? AxisPower::halt : power_;
    }
    stand(t);
}

void Axis::stand(Instant) {
    running_ = false;
    braking_ = want_interrupt_ = false;
    watchdog_ = never;
    changed_ = true;
    if (!interrupted_) {
        task_ = Task::none;
        phase_ = Phase::none;
    }
}

void Axis::ramp_down(Instant t) {
    if (!running_) return;
    const double v = path_.velocity(t);
    const double here = path_.position(t);
    braking_ = true;
    watchdog_ = never;
    run(Path::halt(here, v < 0 ? -1 : 1, std::abs(v), static_cast<double>(p_[ap::start_stop_speed]), motion_.acceleration, t), t);
}

void Axis::finish(Instant t) {
    want_interrupt_ = false;
    interrupted_ = false;
    if (!running_) {
        task_ = Task::none;
        if (power_ == AxisPower::halt && !off_) power_ = AxisPower::on;
        return;
    }
    if (!braking_) ramp_down(t);
}

void Axis::finish_by_condition(Instant t) {
    if (!running_ || braking_) return;
    stopped_by_condition_ = true;
    finish(t);
}

void Axis::skipped_by_condition() noexcept {
    stopped_by_condition_ = true;
    stopped_ = true;
    ended_with_ = 0;
}

void Axis::interrupt(Instant t) {
    if (!running_ || braking_) return;
    // A reference run and a move of the manual kind end here; they have nothing to go on with.
    want_interrupt_ = task_ == Task::position;
    ramp_down(t);
}

void Axis::resume(Instant t) {
    if (!interrupted_ || running_) return;
    if (power_ == AxisPower::halt) power_ = AxisPower::on;
    if (may_start(motion_, t) != quit::ok) return;
    const Motion again = motion_;
    start(again, t);
}

void Axis::renew(Instant t) noexcept {
    if (running_ && !braking_ && task_ == Task::manual) watchdog_ = t + model_.watchdog;
}

void Axis::change_speed(double speed, Instant t) {
    if (!running_ || braking_ || task_ == Task::reference) return;
    motion_.speed = speed;
    const double v = std::abs(path_.velocity(t));
    run(Path::to(path_.position(t), motion_.target, v, speed, static_cast<double>(p_[ap::start_stop_speed]), motion_.acceleration, t), t);
}

/// Stands at once where it is, with an error.
void Axis::abort_with(std::uint16_t number, std::uint16_t code, Instant t) {
    note_lag(t);
    if (running_) rest_ = path_.position(t);
    if (held_) {
        lost_ += rest_ - held_at_;
        held_at_ = rest_;
    }
    if (model_.ep && number == error::following_error) {  // the encoder knows where the shaft is
        rest_ -= lost_;
        held_at_ = rest_;
        lost_ = 0;
        extra_lag_ = 0;
    }
    running_ = braking_ = interrupted_ = want_interrupt_ = false;
    stopped_ = true;
    ended_with_ = code;
    if (fault_ == 0) raised_ = number;
    fault_ = fault_ == 0 ? number : fault_;
    stand(t);
}

void Axis::hit_limit(bool positive, Instant t) {
    abort_with(positive ? error::limit_positive : error::limit_negative, quit::limit_switch, t);
}

void Axis::set_fault(std::uint16_t number, Instant t) {
    abort_with(number, quit::not_ready, t);
    raised_ = 0;  // who sets it knows of it
}

Instant Axis::lag_exceeded() const noexcept {
    const double most = static_cast<double>(p_[ap::following_error]);
    if (!held_ || !running_ || most <= 0 || p_[ap::rotation_monitoring] == 0) return never;
    const double room = path_.direction() * (most - path_.direction() * (lost_ + extra_lag_));
    return path_.when(held_at_ + room);
}

/// When the shaft comes onto the switch in its way while that is monitored. Switches that are exchanged in the parameters stop nothing.
Instant Axis::limit_passed() const noexcept {
    if (!running_ || held_ || !motion_.limits_monitored || task_ == Task::reference || p_[ap::limits_exchanged] != 0) return never;
    const bool up = path_.direction() > 0;
    const double offset = origin_ + lost_;
    if (model_.revolution <= 0) {
        const double end = up ? model_.travel_max : model_.travel_min;
        return switch_at_shaft(up) ? never : path_.when(end + offset);
    }
    const double turn = shaft(now_) / model_.revolution;
    double next = std::floor(turn + edge_slack) + (up ? 1 - switch_share : 0);
    if (up && turn >= next) next += 1;  // it began on the switch
    return path_.when(next * model_.revolution + offset);
}

Instant Axis::deadline() const noexcept {
    if (!running_) return never;
    return std::min({path_.end(), watchdog_, lag_exceeded(), limit_passed()});
}

void Axis::advance(Instant t) {
    if (running_) note_lag(t);
    for (int rounds = 0; running_ && rounds < 16; ++rounds) {  // a motion has at most a handful of events at one instant
        const Instant exceeded = lag_exceeded(), passed = limit_passed();
        if (passed <= t && passed <= path_.end() && passed <= exceeded) {
            const bool up = path_.direction() > 0;
            now_ = std::max(now_, passed);
            hit_limit(up, passed);
            if (model_.revolution > 0) rest_ += (up ? 1 : -1) * model_.revolution * switch_share / 100;  // stands on it
        } else if (exceeded <= t && exceeded <= path_.end()) {
            abort_with(error::following_error, quit::not_ready, exceeded);
        } else if (watchdog_ <= t && watchdog_ < path_.end()) {
            finish(watchdog_);
        } else if (path_.end() <= t) {
            path_ended(path_.end());
        } else {
            break;
        }
    }
    now_ = std::max(now_, t);
}

}  // namespace axisgate::pacontrol::twin
