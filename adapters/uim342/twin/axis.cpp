// Motion states, counter, encoder, lost pulses and stall.
// In: starts, stops, the hand, time. Out: events.
// Never allocates, and never ticks but for a specimen whose shaft is not at its pulses (axis_shaft.cpp).
#include "adapters/uim342/twin/axis.hpp"

#include "adapters/uim342/twin/axis_shaft.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::uim342::twin {
namespace {

constexpr double turn_of_counter = 4294967296.0;  // 2^32
constexpr double most_turns_per_s = 100;          // 6000 rpm: twice the 3000 rpm that motors of the series reach [L91]: a choice (E-63)
constexpr double friction = 50;                   // of the free shaft, turns/s^2: a choice (E-62)

int sign_of(double v) noexcept { return v < 0 ? -1 : (v > 0 ? 1 : 0); }

/// Rate of a ramp that is given in ms between the cut-in speed and `speed`; no ramp if there is nothing between them.
double rate_of_time(double speed, double cut_in, double time_ms) noexcept {
    return speed > cut_in && time_ms > 0 ? 1000.0 * (speed - cut_in) / time_ms : no_ramp;
}

}  // namespace

std::int32_t wrap_i32(double pulses) noexcept {
    const double rounded = std::round(pulses);
    const double inside = rounded - turn_of_counter * std::floor((rounded + turn_of_counter / 2) / turn_of_counter);
    return static_cast<std::int32_t>(inside);
}

double Axis::speed(Instant now) const noexcept {
    if (!mechanics_.closed_loop) return profile_.at(now).velocity;
    return coasting_ ? coast_.at(now).velocity : held_ ? 0 : AxisShaft::lags(*this) ? real_.velocity() : profile_.at(now).velocity;
}

std::int32_t Axis::position(Instant now) const noexcept { return wrap_i32(AxisShaft::counter(*this, now)); }

std::int32_t Axis::place(Instant now) const noexcept { return wrap_i32(AxisShaft::seat(*this, now)); }

std::int32_t Axis::relative(Instant now) const noexcept { return wrap_i32(std::round(AxisShaft::counter(*this, now)) - relative_zero_); }

MotionState Axis::shaft(Instant now) const noexcept {
    if (coasting_) return coast_.at(now);
    if (held_) return {held_at_, 0};
    if (AxisShaft::lags(*this)) return {real_.load() + slip_, out_of_step_ ? 0 : real_.velocity()};
    MotionState s = profile_.at(now);
    s.position += slip_;
    return s;
}

double Axis::turns(Instant now) const noexcept {
    return turns_zero_ + mechanics_.direction * (shaft(now).position - turns_from_) / mechanics_.shaft_per_turn();
}

/// Before the numbering or the resolution changes; the new `turns_from_` is the shaft's place after it.
void Axis::keep_turns(Instant now) noexcept {
    turns_zero_ = turns(now);
    turns_from_ = shaft(now).position;
}

/// The free shaft stands, or is caught: from here on it is where it is.
void Axis::end_coast(Instant now) noexcept {
    if (!coasting_) return;
    const double there = std::round(coast_.at(now).position);
    coasting_ = false;
    if (mechanics_.closed_loop) {
        rest_at(there);
    } else {
        slip_ = there - profile_.end_position();
    }
    AxisShaft(*this).fit(now);
}

int Axis::reverse_direction(Instant now) const noexcept {
    const int moving_now = sign_of(profile_.at(now).velocity);
    if (moving_now != 0) return -moving_now;
    return last_direction_ != 0 ? -last_direction_ : -1;
}

void Axis::rest_at(double position) noexcept {
    profile_ = Profile::rest(position);
    state_ = State::idle;
}

void Axis::power_up(std::int32_t position, Instant now) noexcept {
    follow(now);
    keep_turns(now);
    coasting_ = false;
    rest_at(position);
    relative_zero_ = position;
    driver_on_ = false;
    last_direction_ = 0;
    speed_ = cut_in_ = 0;
    slip_ = 0;
    held_at_ = profile_.end_position();
    lost_ = 0;
    stall_armed_ = speed_armed_ = give_up_ = arrival_pending_ = false;
    stall_at_ = too_fast_at_ = watch_at_ = deadline_ = never;
    was_on_ = false;
    AxisShaft(*this).fit(now);
    turns_from_ = shaft(now).position;
}

void Axis::configure(const Mechanics& mechanics, Instant now) noexcept {
    follow(now);
    keep_turns(now);
    const bool other_loop = mechanics.closed_loop != mechanics_.closed_loop;
    if (mechanics.closed_loop && !mechanics_.closed_loop) {  // from now on the encoder counts: the counter takes the shaft's place
        const double there = std::round(shaft(now).position);
        coasting_ = false;
        rest_at(there);
        slip_ = 0;
    }
    mechanics_ = mechanics;
    if (other_loop && real_.differs()) {  // without a position loop nothing lags by a loop's time
        ShaftFreedoms f = free_;
        if (!mechanics_.closed_loop) f.follow_ms = f.noise_increments = 0;
        const double stands = mechanics_.closed_loop ? profile_.end_position() : real_.load();
        real_ = Shaft(f, seed_);
        real_.set(stands, now);
    }
    turns_from_ = shaft(now).position;
    plan(now);
}

void Axis::set_driver(bool on, Instant now) noexcept {
    if (on == driver_on_) return;
    follow(now);
    if (on) AxisShaft(*this).drift_ends(now);
    driver_on_ = on;
    was_on_ = was_on_ || on;
    lost_ = 0;
    end_coast(now);
    if (!on) {
        const MotionState free = shaft(now);
        if (const int d = sign_of(profile_.at(now).velocity); d != 0) last_direction_ = d;
        const double there = std::round(AxisShaft::seat(*this, now));
        if (out_of_step_) AxisShaft(*this).slip_poles(now);
        if (held_ && !mechanics_.closed_loop) slip_ = held_at_ - there;
        rest_at(there);
        if (held_ && mechanics_.closed_loop) held_at_ = there;
        if (free.velocity != 0) {
            coasting_ = true;
            coast_ = Profile::stop(now, free, friction * mechanics_.shaft_per_turn(), 0);
            if (mechanics_.closed_loop) state_ = State::coast;
        }
        stall_armed_ = speed_armed_ = give_up_ = arrival_pending_ = false;
    }
    plan(now);
}

/// Present state as the base of a new plan, with the counter inside its 32 bits.
MotionState Axis::begin(Instant now) noexcept {
    follow(now);
    MotionState from = profile_.at(now);
    if (const int d = sign_of(from.velocity); d != 0) last_direction_ = d;
    const double turns = turn_of_counter * std::floor((from.position + turn_of_counter / 2) / turn_of_counter);
    if (turns != 0) {
        renumber(turns);
        from.position -= turns;
    }
    arrival_pending_ = give_up_ = overloaded_ = false;
    stall_armed_ = speed_armed_ = true;
    relative_zero_ = std::round(AxisShaft::counter(*this, now));
    if (state_ == State::idle) {
        lost_ = 0;
        started_at_ = relative_zero_;
    }
    return from;
}

Ramps Axis::ramps_for(const Values& values, double speed, MotionState from) const noexcept {
    Ramps r;
    r.cut_in = values.ss;
    r.backlash = values.bl;
    r.last_direction = last_direction_;
    if (values.as_time) {
        r.acceleration = rate_of_time(speed, values.ss, values.ac);
        // The time of a deceleration runs from the faster of what is and what is wanted: slowing down takes DC ms as well.
        r.deceleration = rate_of_time(std::max(speed, std::abs(from.velocity)), values.ss, values.dc);
    } else {
        r.acceleration = values.ac;
        r.deceleration = values.dc;
    }
    return r;
}

void Axis::run(State state, const Profile& profile, double speed, const Values& values, Instant now) noexcept {
    profile_ = profile;
    state_ = state;
    speed_ = speed;
    cut_in_ = values.ss;
    plan(now);
}

void Axis::jog(Instant now, double velocity, const Values& values) noexcept {
    const MotionState from = begin(now);
    const double speed = std::abs(velocity);
    run(State::jog, Profile::jog(now, from, velocity, ramps_for(values, speed, from)), speed, values, now);
}

void Axis::start_move(Instant now, double target, double speed, const Values& values, MotionState from) noexcept {
    run(State::ptp, Profile::move(now, from, target, speed, ramps_for(values, speed, from)), speed, values, now);
}

void Axis::move_to(Instant now, std::int32_t target, double speed, const Values& values) noexcept {
    const MotionState from = begin(now);
    start_move(now, target, speed, values, from);
}

void Axis::move_by(Instant now, std::int64_t displacement, double speed, const Values& values) noexcept {
    const MotionState from = begin(now);
    start_move(now, std::round(AxisShaft::counter(*this, now)) + static_cast<double>(displacement), speed, values, from);
}

void Axis::run_stop(State state, double rate, Instant now) noexcept {
    if (state_ == State::idle || coasting_) return;
    follow(now);
    const MotionState from = profile_.at(now);
    if (const int d = sign_of(from.velocity); d != 0) last_direction_ = d;
    profile_ = Profile::stop(now, from, rate, cut_in_);
    state_ = state;
    plan(now);
}

void Axis::stop_slowly(Instant now, std::uint32_t dc, bool as_time) noexcept {
    const double fastest = std::max(speed_, std::abs(profile_.at(now).velocity));
    run_stop(State::slow_stop, as_time ? rate_of_time(fastest, cut_in_, dc) : dc, now);
}

void Axis::stop_fast(Instant now, std::uint32_t sd) noexcept { run_stop(State::emergency_stop, sd, now); }

void Axis::renumber(double pulses) noexcept {
    profile_.shift(pulses);
    coast_.shift(pulses);
    real_.shift(-pulses);
    relative_zero_ -= pulses;
    started_at_ -= pulses;
    turns_from_ -= pulses;
    held_at_ -= pulses;
}

void Axis::set_origin(Instant now) noexcept {
    follow(now);
    if (!mechanics_.closed_loop) keep_turns(now);
    renumber(std::round(AxisShaft::counter(*this, now)));
    relative_zero_ = 0;
    if (!mechanics_.closed_loop) {  // where the pulses are is the new zero; what was lost before lies behind it
        slip_ = 0;
        if (held_) held_at_ = profile_.at(now).position;
        if (coasting_) coast_.shift(coast_.at(now).position);
        turns_from_ = shaft(now).position;
    }
    plan(now);
}

Axis::Event Axis::hold(bool held, Instant now) noexcept {
    if (held == held_) return Event::none;
    follow(now);
    if (held) {
        held_at_ = shaft(now).position;
        end_coast(now);
        held_ = true;
        plan(now);
        return Event::none;
    }
    if (!mechanics_.closed_loop) slip_ = held_at_ - profile_.at(now).position;
    held_ = false;
    if (mechanics_.closed_loop)
        real_.set(held_at_, now);
    else
        AxisShaft(*this).fit(now);
    plan(now);
    if (!arrival_pending_) return Event::none;
    arrival_pending_ = false;
    return Event::arrived;
}

Axis::Event Axis::lose(std::int64_t pulses, Instant now) noexcept {
    if (!mechanics_.closed_loop) {
        const int moving_now = sign_of(speed(now));
        slip_ -= static_cast<double>(pulses) * (moving_now != 0 ? moving_now : (last_direction_ != 0 ? last_direction_ : 1));
        return Event::none;
    }
    lost_ += pulses;
    if (lost_ >= mechanics_.tolerance) return stall(now);
    plan(now);
    return Event::none;
}

void Axis::forget_lost(Instant now) noexcept {
    lost_ = 0;
    plan(now);
}

void Axis::displace(double position, Instant now) noexcept {
    const double there = std::round(position);
    follow(now);
    end_coast(now);
    if (mechanics_.closed_loop) {
        relative_zero_ += there - profile_.end_position();
        rest_at(there);
        slip_ = 0;
    } else {
        slip_ = there - profile_.end_position();
    }
    held_at_ = there;
    was_on_ = false;  // it stands where the hand has left it
    AxisShaft(*this).fit(now);
}

Axis::Event Axis::stall(Instant at) noexcept {
    lost_ = 0;
    overloaded_ = false;
    stall_armed_ = false;
    if (state_ == State::idle) {
        if (held_) rest_at(std::round(held_at_));
        arrival_pending_ = false;
    } else {
        give_up_ = true;
    }
    plan(at);
    return Event::stalled;
}

Axis::Event Axis::step(Instant at) noexcept {
    if (at < deadline_) return Event::none;
    follow(at);
    if (coasting_) {
        end_coast(at);
        plan(at);
        return Event::stopped;
    }
    if (at >= stall_at_) return stall(at);
    if (at >= too_fast_at_) {
        speed_armed_ = false;
        plan(at);
        return Event::too_fast;
    }
    if (at >= watch_at_ && at < profile_.end()) {
        if (overloaded_) return stall(at);
        plan(at);
        return Event::none;
    }
    const bool target = state_ == State::ptp && profile_.reaches_target();
    if (const int d = profile_.last_direction(); d != 0) last_direction_ = d;
    double there = profile_.end_position();
    if (give_up_ && held_ && mechanics_.closed_loop) there = held_at_ = std::round(held_at_);
    if (give_up_ && mechanics_.closed_loop && AxisShaft::lags(*this)) there = std::round(real_.load());
    give_up_ = false;
    rest_at(there);
    arrival_pending_ = target && held_ && mechanics_.closed_loop && std::round(held_at_) != there;
    plan(at);
    if (!target || arrival_pending_) return Event::stopped;
    return Event::arrived;
}

void Axis::plan(Instant now) noexcept {
    deadline_ = coasting_ ? coast_.end() : state_ == State::idle ? never : profile_.end();
    stall_at_ = too_fast_at_ = watch_at_ = never;
    if (!driver_on_ || state_ == State::idle) return;
    if (mechanics_.closed_loop && stall_armed_) {
        const double left = static_cast<double>(mechanics_.tolerance) - static_cast<double>(lost_);
        // The motor takes other pulses for a turn than the drive makes of the encoder's: the difference counts as lost.
        const double apart = std::abs(mechanics_.pulses_per_turn / mechanics_.feedback_per_turn - 1);
        if (held_) {
            stall_at_ = profile_.first_departure(now, held_at_, left);
        } else if (apart > 1e-9) {
            stall_at_ = profile_.first_departure(now, started_at_, left / apart);
        }
    }
    if (speed_armed_ && !held_) too_fast_at_ = profile_.first_faster(now, most_turns_per_s * mechanics_.shaft_per_turn() * (1 + 1e-9));
    constexpr Duration watch = std::chrono::milliseconds(10);
    if (free_.most_acceleration != 0 && mechanics_.closed_loop && stall_armed_ && AxisShaft::lags(*this)) watch_at_ = now + watch;
    deadline_ = std::min({deadline_, stall_at_, too_fast_at_, watch_at_});
}

}  // namespace axisgate::uim342::twin
