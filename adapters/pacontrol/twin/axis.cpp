// Power, reference, limits, measuring mode of one axis, and what a tester's hand does to it.
// In: commands, hand. Out: states and errors. Never moves anything but by hand and by the measuring mode's synchronisation.
#include "adapters/pacontrol/twin/axis.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::pacontrol::twin {

std::uint8_t Axis::status() const noexcept { return status_of(state_, shaft_, traverse_); }

void Axis::advance(Instant t) {
    traverse_.follow(t);
    shown_.before(t);
    if (state_.on_at <= t) (void)switch_on(t, state_.on_goes_on);
    traverse_.advance(t);
}

void Axis::set_referenced(bool on) noexcept {
    state_.referenced = on;
    state_.changed = true;
}

/// The counter changes, the software limits do not [L748].
void Axis::set_position_g26(double x, bool reference) noexcept {
    shaft_.rename(x);
    traverse_.renamed();
    if (reference) state_.referenced = true;
    state_.changed = true;
}

/// The counter changes and the software limits move along [L756].
void Axis::set_position_g29(double x) noexcept {
    state_.shift += x - shaft_.rest();
    set_position_g26(x, false);
}

void Axis::delete_g29() noexcept {
    const double s = state_.shift;
    state_.shift = 0;
    set_position_g26(shaft_.rest() - s, false);
}

std::uint16_t Axis::switch_on(Instant t, bool go_on) {
    const Instant on_at = std::exchange(state_.on_at, never);
    if (state_.fault != 0 || !state_.outside.power_pack || state_.measuring) return quit::not_ready;
    const bool is_on = state_.enabled() && !state_.off;
    if (model_.axis_on > Duration::zero() && !is_on && on_at > t) {
        state_.on_at = on_at != never ? on_at : t + model_.axis_on;
        state_.on_goes_on = go_on;
        return quit::ok;
    }
    const bool was_off = std::exchange(state_.off, false) || !state_.enabled();
    if (was_off && model_.switch_on_mode == 4 && std::abs(shaft_.place(t) - state_.off_place) > model_.max_displacement) {
        state_.displaced = true;
        traverse_.forget_interrupted();
    }
    if (state_.power != AxisPower::on) state_.power = traverse_.interrupted() ? AxisPower::halt : AxisPower::on;
    if (!traverse_.interrupted() || !go_on) return quit::ok;
    if (model_.switch_on_mode == 0) {
        state_.power = AxisPower::on;
        traverse_.finish(t);
    } else {
        traverse_.resume(t);
    }
    return quit::ok;
}

/// Enable mode [L734-738]; its values but 1 are not printed: 0 and 1 IDLE, 2 HALT, 3 SAFE in this model.
void Axis::switch_off(Instant t) {
    state_.on_at = never;
    if (state_.off || !state_.enabled()) return;
    state_.off = true;
    state_.off_position = shaft_.position(t);
    state_.off_place = shaft_.place(t);
    traverse_.interrupt(t);
    const int mode = static_cast<int>(p_[ap::enable_mode]);
    state_.power = mode == 2 ? AxisPower::halt : mode == 3 ? AxisPower::safe : AxisPower::idle;
    if (!shaft_.running()) state_.off_position = shaft_.rest();
}

void Axis::disable(bool disabled, Instant t) {
    if (disabled && state_.power != AxisPower::disabled) {
        traverse_.drop(t);
        state_.power = AxisPower::disabled;
    } else if (!disabled && state_.power == AxisPower::disabled) {
        shaft_.take_over();  // the present position becomes the actual one
        state_.power = AxisPower::idle;
        state_.off_place = shaft_.place(t);
    }
}

void Axis::set_fault(std::uint16_t number, Instant t) {
    traverse_.abort_with(number, quit::not_ready, t);
    state_.raised = 0;  // who sets it knows of it
}

std::uint16_t Axis::begin_measuring() {
    if (!model_.measuring) return quit::no_measuring;
    if (shaft_.running()) return quit::moves;
    if (state_.fault != 0) return quit::not_ready;
    state_.measuring = true;
    return quit::ok;
}

std::uint16_t Axis::end_measuring() {
    if (!state_.measuring) return quit::ok;  // acknowledged, nothing done [L3818]
    state_.measuring = false;
    if (!model_.ep) return quit::ok;
    if (p_[ap::synchronise] != 0) {
        const double gear = static_cast<double>(p_[ap::gear]);
        const double edges = 4 * static_cast<double>(p_[ap::encoder_pulses]);
        const double most = 4 * gear / std::max(1.0, static_cast<double>(p_[ap::full_steps]));
        const double at = shaft_.rest_place();
        const double next = edges > 0 ? std::ceil(at * edges / gear - 1e-9) * gear / edges : at;
        if (state_.outside.encoder_broken || edges <= 0 || next - at > most) {
            shaft_.count(most);  // the counter, not the shaft, has moved so far
            traverse_.abort_with(error::no_encoder_edge, quit::not_executable, Instant{});
            return quit::not_executable;
        }
        shaft_.count(next - at);
    }
    if (p_[ap::take_over] != 0) shaft_.take_over();
    shaft_.hold_here();
    state_.changed = true;
    return quit::ok;
}

void Axis::lose_power(Instant t) {
    shaft_.freeze(t);
    shaft_.keep_lost();
    traverse_.drop(t);
}

void Axis::boot(const Kept& kept) {
    const bool absolute = p_[ap::absolute] != 0;
    shaft_.boot(absolute ? kept.position : 0, kept.shaft);
    traverse_.boot();
    state_.measuring = state_.displaced = false;
    state_.fault = state_.raised = 0;
    state_.shift = absolute ? kept.shift : 0;
    state_.referenced = absolute;
    state_.off_position = shaft_.rest();
    state_.off_place = kept.shaft;
    state_.off = static_cast<int>(p_[ap::enable_mode]) != 1;
    state_.power = state_.off ? AxisPower::idle : AxisPower::on;
    state_.on_at = never;
    shown_.boot();
}

// --- the hand ---

void Axis::hold(bool held, Instant t) {
    if (held == shaft_.held()) return;
    shaft_.hold(held, t);
    if (!held) state_.changed = true;
}

void Axis::set_limit(bool positive, bool actuated, Instant t) {
    switches_.set_limit(positive, actuated);
    if (actuated) traverse_.limit_changed(t);
}

void Axis::set_home_switch(bool active, Instant t) {
    if (active == switches_.home_by_hand()) return;
    switches_.set_home(active);
    traverse_.home_changed(active, t);
}

void Axis::set_following_error(double ae, Instant t) {
    shaft_.set_extra_lag(ae);
    shaft_.note_lag(t);
    const double most = static_cast<double>(p_[ap::following_error]);
    if (state_.enabled() && !state_.measuring && most > 0 && p_[ap::rotation_monitoring] != 0 && std::abs(shaft_.lag(t)) > most &&
        state_.fault == 0) {
        traverse_.abort_with(error::following_error, quit::not_ready, t);
    }
}

void Axis::set_power_pack(bool ready, Instant t) {
    state_.outside.power_pack = ready;
    if (!ready && state_.enabled() && !state_.measuring && state_.fault == 0) traverse_.abort_with(error::power_pack, quit::not_ready, t);
}

bool Axis::push_to(double ae, bool supply, Instant t) {
    if (!supply) {
        shaft_.count(ae - shaft_.rest_place());
        shaft_.hold_here();
    } else if (shaft_.running() || (state_.enabled() && !state_.measuring)) {
        return false;
    } else {
        const double way = ae - shaft_.place(t);
        shaft_.push(way, !state_.measuring);  // measuring: the encoder counts it, the position counter does not until measuring ends
    }
    state_.changed = true;
    return true;
}

}  // namespace axisgate::pacontrol::twin
