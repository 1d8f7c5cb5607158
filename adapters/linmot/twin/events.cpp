// What becomes due inside a simulated drive: ends of tests and motions, crossings, trigger edges, steps of the command table, limits.
// In: the passing of time. Out: everything at its own instant and in order. Never runs ahead of what was asked.
#include <algorithm>
#include <cmath>

#include "adapters/linmot/twin/drive.hpp"

namespace axisgate::linmot::twin {
namespace {
constexpr Duration watch_step = std::chrono::milliseconds(1);  ///< how often a condition is looked at that has no closed form
Duration ms(double n) { return Duration{static_cast<std::int64_t>(std::clamp(n, 0.0, 1e9) * 1e6)}; }
}  // namespace

void Drive::advance(Instant now) {
    if (now < now_) return;
    // Bounded: a table that loops without a wait takes a cycle per entry, and next_event() has it looked at often enough.
    for (int i = 0; i < 100'000; ++i) {
        const Instant at = due();
        if (at > now) break;
        now_ = std::max(now_, at);
        handle(now_);
    }
    now_ = now;
}

bool Drive::watches() const noexcept { return waiting_ != 0 && (waiting_ >> 8 == 0x22 || (waiting_ & 0xFFF0) == 0x2120); }

/// While the motor is held, the demand runs away until the lag is too big (error 000Bh) at its very instant.
Instant Drive::lag_limit(Instant after) const {
    if (!outside_.stall || !controlled() || (state_ == quick_stop && quick_by_error_)) return never;
    const double limit = memory.number(0x1473);
    if (limit <= 0) return never;
    const double here = stalled_at_ + offset_;
    if (std::fabs(demand_at(now_).position - here) > limit) return now_;
    if (play_.active || streaming_ || follows()) return now_ + watch_step;
    const auto up = profile_.crossing(here + limit, true, after);
    const auto down = profile_.crossing(here - limit, false, after);
    return std::min(up.value_or(never), down.value_or(never));
}

/// The position leaves the range of 146Eh and 146Fh; each is watched by its crossing.
Instant Drive::range_limit(Instant after) const {
    if (!controlled() || (state_ == quick_stop && quick_by_error_) || play_.active || streaming_ || follows() || outside_.stall ||
        profile_.over(now_) || !homed_)
        return never;
    const auto up = profile_.crossing(memory.number(0x146F), true, after);
    const auto down = profile_.crossing(memory.number(0x146E), false, after);
    return std::min(up.value_or(never), down.value_or(never));
}

Instant Drive::due() const {
    if (!running_) return never;
    Instant at = never;
    const auto take = [&](Instant t) { at = std::min(at, std::max(t, now_)); };
    if (state_ == hardware_tests) take(since_ + test_time);
    if (state_ == phase_search && sub_ == 0) take(since_ + std::chrono::seconds(1));
    if (const Instant t = monitor_due(); t != never) take(t);
    if (controlled()) {
        if (const Instant t = follow_due(); t != never) take(t);
        if (indexing_ && outside_.encoder_speed != 0) take(now_ + watch_step);
        if (play_.active)
            take(play_.begun + ms(play_.seconds * 1000));
        else if (!streaming_ && !follows() &&
                 (after_ || (sub_ != 0x0F && state_ >= homing && state_ <= to_initial) || (state_ == to_position && sub_ != 0x0F) ||
                  state_ == quick_stop)) {
            if (profile_.end() != never) {
                const bool brake = state_ == quick_stop && memory.ram(0x1716) != 0 && memory.ram(0x1717) != 0;
                take(std::max(profile_.end(), since_) + (brake ? ms(memory.number(0x171B)) : Duration{}));
            }
        }
        if (state_ == operation_enabled && (event_.kind == Event::Kind::upwards || event_.kind == Event::Kind::downwards)) {
            if (const auto t = profile_.crossing(event_.position, event_.kind == Event::Kind::upwards, now_)) take(*t);
        }
        if (const Instant t = lag_limit(now_); t != never) take(t);
        if (const Instant t = range_limit(now_); t != never) take(t);
        if (streaming_)
            take(stream_points_.size() > 1
                     ? stream_points_[1].first
                     : stream_last_ + (stream_period_ > Duration{} ? stream_period_ * 3 : Duration{std::chrono::milliseconds(8)}));
        if (!delayed_.empty()) take(delayed_.front().first);
        if (entry_ != 0) {
            if (waiting_ == 0)
                take(step_at_);
            else if (waiting_ == 0x2110)
                take(play_.active || streaming_ || follows() || profile_.endless() ? never : profile_.end() + Duration{1});
            else if (wait_until_ != never)
                take(wait_until_);
            else if (watches())
                take(now_ + watch_step);
        }
    }
    return at;
}

Instant Drive::next_event() const {
    // What only moves on inside needs no wake-up but to keep the catching up short. Asked after every telegram of the line: cheap.
    if (!running_ || (entry_ == 0 && !streaming_)) return never;
    const Instant at = due();
    return at == never ? never : std::max(at, now_ + std::chrono::milliseconds(50));
}

void Drive::handle(Instant now) {
    if (monitors()) {
        check_outside(now);
        compute_control_word(now);
    }
    follow_step(now);
    if (state_ == hardware_tests && now >= since_ + test_time) {
        enter(ready_to_operate, now);
        evaluate(now);
        return;
    }
    if (state_ == phase_search && sub_ == 0 && now >= since_ + std::chrono::seconds(1)) {
        sub_ = 0x0F;
        memory.set_ram(0x1C1B, 90);
        return;
    }
    if (!controlled()) return;
    const Instant before = now - Duration{2};  // an instant is the first nanosecond after its event
    if (lag_limit(before) <= now) return raise(motion_active() || setup_.series == Series::b1100 ? 0x0B : 0x0C, now);
    if (range_limit(before) <= now) {
        const double v = profile_.at(now).velocity;
        const bool up = v > 0;
        return raise(up ? 0x08 : 0x07, now);
    }
    if (state_ == operation_enabled && (event_.kind == Event::Kind::upwards || event_.kind == Event::Kind::downwards)) {
        const auto t = profile_.crossing(event_.position, event_.kind == Event::Kind::upwards, before);
        if (t && *t <= now) {
            fire(now);
            return;
        }
    }
    if (!delayed_.empty() && delayed_.front().first <= now) {
        const bool rising = delayed_.front().second;
        delayed_.pop_front();
        fire_trigger(rising, now);
        return;
    }
    if (indexing_ && outside_.encoder_speed != 0) index(now);
    if (streaming_) {
        if (stream_points_.size() > 1 && stream_points_[1].first <= now) {
            stream_points_.pop_front();
            return;
        }
        if (stream_points_.size() <= 1 &&
            now >= stream_last_ + (stream_period_ > Duration{} ? stream_period_ * 3 : Duration{std::chrono::milliseconds(8)})) {
            const Point p = demand_at(now);
            streaming_ = false;
            profile_.rest(p.position, now);
            return raise(0x83, now);
        }
    }
    const bool play_ends = play_.active && now >= play_.begun + ms(play_.seconds * 1000);
    if (play_ends) {
        stop_play(now);
        return;
    }
    if (!play_.active && !streaming_ && !follows() && profile_.over(now)) {
        const bool waits_for_it = after_ || state_ == quick_stop || (state_ >= homing && state_ <= to_initial) || state_ == to_position;
        const bool brake = state_ == quick_stop && memory.ram(0x1716) != 0 && memory.ram(0x1717) != 0;
        if (waits_for_it && sub_ != 0x0F && (!brake || now >= std::max(profile_.end(), since_) + ms(memory.number(0x171B)))) {
            motion_over(now);
            if (state_ != operation_enabled || !after_) return;
        }
    }
    if (entry_ != 0 && wait_over(now)) step_table(now);
}

/// The running set-point generation has ended, and something waits for that.
void Drive::motion_over(Instant now) {
    switch (state_) {
        case quick_stop:
            if (quick_by_error_) {
                const std::uint16_t code = error_;
                enter(error, now);
                error_ = code;
                quick_by_error_ = false;
            } else {
                enter(switch_on_disabled, now);
            }
            evaluate(now);
            return;
        case homing:
            // The mechanical reference is reached: from here on it has the home position's name.
            offset_ = memory.number(0x13C7) - actual_at(now).position;
            profile_.rest(actual_at(now).position + offset_, now);
            target_ = profile_.target();
            homed_ = true;
            sub_ = 0x0F;
            return;
        case clearance:
        case to_initial:
        case to_position:
            sub_ = 0x0F;
            return;
        default:
            break;
    }
    if (after_) {
        const Order order = *after_;
        after_.reset();
        start(order, now);
    }
}

/// The armed event has come. It stays armed; only 008xh ends it [L983-989].
void Drive::fire(Instant now) {
    if (state_ != operation_enabled) return;
    const Event e = event_;
    switch (e.what) {
        case Event::What::vai:
            start(e.order, now);
            break;
        case Event::What::change: {
            last_ramps_ = e.order.ramps;
            if (profile_.endless())
                profile_.run(now, demand_at(now), demand_at(now).velocity < 0 ? -1 : 1, e.order.ramps);
            else if (!profile_.over(now))
                profile_.move(now, demand_at(now), profile_.target(), e.order.ramps);
            break;
        }
        case Event::What::table:
            start_entry(static_cast<std::uint16_t>(e.order.value), now);
            break;
        case Event::What::cam:
            start_shot(e.order.sub, e.bytes, now);
            break;
        case Event::What::curve:
            start_curve(e.order.sub, e.bytes, now);
            break;
    }
}

/// An edge behind its filter.
void Drive::fire_trigger(bool rising, Instant now) {
    const std::uint16_t wanted = rising ? 0x2130 : 0x2140;
    if (waiting_ == wanted) wait_edge_ = true;
    if (event_.kind == (rising ? Event::Kind::rising : Event::Kind::falling)) fire(now);
    if (entry_ != 0 && wait_over(now)) step_table(now);
}

/// The input X4.6 with its modes [L4251-4363]: an accepted edge blocks others for a time, or is passed on later, or both.
void Drive::trigger(bool rising, Instant now) {
    advance(now);
    if (rising == trigger_level_) return;
    trigger_level_ = rising;
    const auto mode = memory.ram(0x170C);
    if (mode == 0 || !running_) return;
    if (mode == 2 || mode == 4) {
        if (now < inhibited_until_) return;
        inhibited_until_ = now + ms(memory.number(rising ? 0x170D : 0x170E));
    }
    if (mode == 3 || mode == 4) {
        if (delayed_.size() < 16) delayed_.emplace_back(now + ms(memory.number(rising ? 0x170F : 0x1710)), rising);
        return;
    }
    fire_trigger(rising, now);
}

}  // namespace axisgate::linmot::twin
