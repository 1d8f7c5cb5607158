// Power, reference, limits, measuring mode of one axis, and what a tester's hand does to it.
// In: commands, hand. Out: states and errors. Never moves anything but by hand and by the measuring mode's synchronisation.
#include <algorithm>
#include <cmath>

#include "adapters/pacontrol/twin/axis.hpp"

namespace axisgate::pacontrol::twin {

bool Axis::limit_actuated(bool positive) const noexcept {
    const bool exchanged = p_[ap::limits_exchanged] != 0;
    const bool at_positive = positive != exchanged;
    return (at_positive ? limit_positive_ : limit_negative_) || switch_at_shaft(at_positive);
}

bool Axis::switch_at_shaft(bool positive) const noexcept {
    const double at = shaft(now_);
    if (model_.revolution <= 0) return positive ? at >= model_.travel_max - 1e-6 : at <= model_.travel_min + 1e-6;
    const double turn = at / model_.revolution;
    const double part = turn - std::floor(turn);
    return part >= 1 - switch_share - 1e-9 && part < 1 - 1e-9;
}

void Axis::set_referenced(bool on) noexcept {
    referenced_ = on;
    changed_ = true;
}

/// The counter changes, the software limits do not [L748].
void Axis::set_position_g26(double x, bool reference) noexcept {
    origin_ += x - rest_;
    held_at_ += x - rest_;
    rest_ = x;
    target_ = x;
    if (reference) referenced_ = true;
    changed_ = true;
}

/// The counter changes and the software limits move along [L756].
void Axis::set_position_g29(double x) noexcept {
    shift_ += x - rest_;
    set_position_g26(x, false);
}

void Axis::delete_g29() noexcept {
    const double s = shift_;
    shift_ = 0;
    set_position_g26(rest_ - s, false);
}

std::uint16_t Axis::switch_on(Instant t, bool go_on) {
    if (fault_ != 0 || !power_pack_ || measuring_) return quit::not_ready;
    const bool was_off = std::exchange(off_, false) || !enabled();
    if (was_off && model_.switch_on_mode == 4 && std::abs(shaft(t) - off_shaft_) > model_.max_displacement) {
        displaced_ = true;
        interrupted_ = false;
    }
    if (power_ != AxisPower::on) power_ = interrupted_ ? AxisPower::halt : AxisPower::on;
    if (!interrupted_ || !go_on) return quit::ok;
    if (model_.switch_on_mode == 0) {
        power_ = AxisPower::on;
        interrupted_ = false;
        task_ = Task::none;
    } else {
        resume(t);
    }
    return quit::ok;
}

/// Enable mode [L734-738]; its values but 1 are not printed: 0 and 1 IDLE, 2 HALT, 3 SAFE in this model.
void Axis::switch_off(Instant t) {
    if (off_ || !enabled()) return;
    off_ = true;
    off_position_ = position(t);
    off_shaft_ = shaft(t);
    if (running_ && !braking_) {
        want_interrupt_ = task_ == Task::position;
        ramp_down(t);
    }
    const int mode = static_cast<int>(p_[ap::enable_mode]);
    power_ = mode == 2 ? AxisPower::halt : mode == 3 ? AxisPower::safe : AxisPower::idle;
    if (!running_) off_position_ = rest_;
}

void Axis::disable(bool disabled, Instant t) {
    if (disabled && power_ != AxisPower::disabled) {
        if (running_) rest_ = path_.position(t);
        running_ = braking_ = interrupted_ = want_interrupt_ = false;
        stand(t);
        power_ = AxisPower::disabled;
    } else if (!disabled && power_ == AxisPower::disabled) {
        rest_ -= lost_;  // the present position becomes the actual one
        held_at_ = rest_;
        lost_ = 0;
        power_ = AxisPower::idle;
        off_shaft_ = shaft(t);
    }
}

std::uint16_t Axis::begin_measuring() {
    if (!model_.measuring) return quit::no_measuring;
    if (running_) return quit::moves;
    if (fault_ != 0) return quit::not_ready;
    measuring_ = true;
    return quit::ok;
}

std::uint16_t Axis::end_measuring() {
    if (!measuring_) return quit::ok;  // acknowledged, nothing done [L3818]
    measuring_ = false;
    if (!model_.ep) return quit::ok;
    if (p_[ap::synchronise] != 0) {
        const double gear = static_cast<double>(p_[ap::gear]);
        const double edges = 4 * static_cast<double>(p_[ap::encoder_pulses]);
        const double most = 4 * gear / std::max(1.0, static_cast<double>(p_[ap::full_steps]));
        const double at = rest_ - origin_ - lost_;
        const double next = edges > 0 ? std::ceil(at * edges / gear - 1e-9) * gear / edges : at;
        if (encoder_broken_ || edges <= 0 || next - at > most) {
            rest_ += most;  // the counter, not the shaft, has moved so far
            abort_with(error::no_encoder_edge, quit::not_executable, Instant{});
            return quit::not_executable;
        }
        rest_ += next - at;
    }
    if (p_[ap::take_over] != 0) {
        rest_ -= lost_;
        lost_ = 0;
    }
    held_at_ = rest_;
    changed_ = true;
    return quit::ok;
}

void Axis::lose_power(Instant t) {
    if (running_) rest_ = path_.position(t);
    if (held_) lost_ += rest_ - held_at_;
    held_at_ = rest_;
    running_ = braking_ = interrupted_ = want_interrupt_ = false;
    stand(t);
}

void Axis::boot(const Kept& kept) {
    const bool absolute = p_[ap::absolute] != 0;
    running_ = braking_ = interrupted_ = want_interrupt_ = stopped_ = measuring_ = displaced_ = stopped_by_condition_ = false;
    task_ = Task::none;
    phase_ = Phase::none;
    fault_ = raised_ = ended_with_ = 0;
    lost_ = 0;
    rest_ = absolute ? kept.position : 0;
    origin_ = rest_ - kept.shaft;
    shift_ = absolute ? kept.shift : 0;
    referenced_ = absolute;
    held_at_ = target_ = off_position_ = rest_;
    off_shaft_ = kept.shaft;
    greatest_lag_ = 0;
    off_ = static_cast<int>(p_[ap::enable_mode]) != 1;
    power_ = off_ ? AxisPower::idle : AxisPower::on;
}

// --- the hand ---

void Axis::hold(bool held, Instant t) {
    if (held == held_) return;
    note_lag(t);
    if (held) {
        held_at_ = position(t);
    } else {
        lost_ += position(t) - held_at_;
        changed_ = true;
    }
    held_ = held;
}

void Axis::set_limit(bool positive, bool actuated, Instant t) {
    (positive ? limit_positive_ : limit_negative_) = actuated;
    if (!actuated || !running_ || !motion_.limits_monitored || task_ == Task::reference) return;
    const double v = path_.velocity(t);
    if (v > 0 && limit_actuated(true)) hit_limit(true, t);
    if (v < 0 && limit_actuated(false)) hit_limit(false, t);
}

void Axis::set_home_switch(bool active, Instant t) {
    if (active == home_forced_) return;
    home_forced_ = active;
    if (!running_ || task_ != Task::reference || braking_) return;
    if ((phase_ == Phase::seek && active) || (phase_ == Phase::creep_out && !active)) {
        // The switch changed under way: that is the edge.
        rest_ = path_.position(t);
        running_ = false;
        if (phase_ == Phase::creep_out) phase_ = Phase::creep_back;
        next_phase(t);
    }
}

void Axis::set_following_error(double ae, Instant t) {
    extra_lag_ = ae;
    note_lag(t);
    const double most = static_cast<double>(p_[ap::following_error]);
    if (enabled() && !measuring_ && most > 0 && p_[ap::rotation_monitoring] != 0 && std::abs(lag(t)) > most && fault_ == 0) {
        abort_with(error::following_error, quit::not_ready, t);
    }
}

void Axis::set_power_pack(bool ready, Instant t) {
    power_pack_ = ready;
    if (!ready && enabled() && !measuring_ && fault_ == 0) abort_with(error::power_pack, quit::not_ready, t);
}

bool Axis::push_to(double ae, Instant t) {
    if (running_ || (enabled() && !measuring_)) return false;
    const double way = ae - shaft(t);
    if (measuring_) {
        lost_ -= way;  // the encoder counts it, the position counter does not until measuring ends
    } else {
        rest_ += way;
        held_at_ += way;
    }
    changed_ = true;
    return true;
}

bool Axis::push_unpowered(double ae) noexcept {
    rest_ += ae - (rest_ - origin_ - lost_);
    held_at_ = rest_;
    changed_ = true;
    return true;
}

}  // namespace axisgate::pacontrol::twin
