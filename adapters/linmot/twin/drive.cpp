// States and words of a simulated drive: control word sources, transitions, errors, status word, StateVar, warn word.
// In: words, time. Out: states. Never jumps over an event that was due before.
#include "adapters/linmot/twin/drive.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::linmot::twin {

bool Drive::is_fatal(std::uint16_t code) noexcept {
    static constexpr std::array<std::uint16_t, 9> fatal{0x0A, 0x0D, 0x21, 0x22, 0x45, 0x64, 0x65, 0x67, 0x68};
    return std::ranges::find(fatal, code) != fatal.end();
}

// --- power ---------------------------------------------------------------------------------------------------------------
void Drive::power_on(Instant now) {
    on_ = true;
    memory.restart();
    now_ = now;
    interface_word_ = 0x0001;  // state 0 is left when bit 0 is seen low: nothing starts with a complete word [L105-107]
    echo_ = 0;
    last_header_ = 0;
    homed_ = vai_ever_ = fatal_ = false;
    error_ = 0;
    offset_ = 0;
    x4_outputs_ = x6_outputs_ = 0;
    cams_ = {};
    master_.power_on();
    resistor_.settle(memory.number(0x102A) / 10);
    motor_.settle(memory.number(0x102A) / 10);
    warmed_ = now;
    show_temperatures();
    start_software(now);
}

void Drive::power_off(Instant now) {
    advance(now);
    unpower(now);
    on_ = running_ = false;
    enter(not_ready, now);
}

void Drive::stop_software(Instant now) {
    advance(now);
    unpower(now);
    running_ = false;
    enter(not_ready, now);
}

void Drive::start_software(Instant now) {
    now_ = now;
    running_ = true;
    homed_ = false;
    error_ = 0;
    fatal_ = false;
    unpower(now);
    enter(not_ready, now);
    interface_word_ |= 1;
    if (memory.ram(0x170C) == 0) raise(0x65, now);
    if (memory.ram(0x101D) != 0) {  // regeneration is configured: above the supply at rest, and half a volt apart
        const double on = memory.number(0x101E), off = memory.number(0x101F), idle = static_cast<double>(outside_.motor_supply);
        if (on < idle || off < idle) raise(0x60, now);
        if (on - off < 50) raise(0x61, now);
    }
    compute_control_word(now);
}

void Drive::freeze_mechanics(Instant now) {
    if (!controlled()) return;
    physical_ = actual_at(now).position;
}

void Drive::unpower(Instant now) {
    freeze_mechanics(now);
    profile_.rest(physical_ + offset_, now);
    after_.reset();
    event_ = {};
    delayed_.clear();
    play_ = {};
    follow_ = Follow::none;
    memory.set_ram(0x1BA9, 0);
    abort_over_ = never;
    indexing_ = streaming_ = force_watch_ = force_control_ = false;
    stream_points_.clear();
    end_table();
}

void Drive::enter(std::uint8_t state, Instant now) {
    const bool was = controlled();
    if (was && state < operation_enabled) unpower(now);
    state_ = state;
    sub_ = 0;
    since_ = now;
    if (!was && state >= operation_enabled) {  // the actual position becomes the demand: nothing moves because it was enabled
        profile_.rest(physical_ + offset_, now);
        target_ = physical_ + offset_;
        stalled_at_ = physical_;
        echo_ = static_cast<std::uint8_t>(buffer_[0] & 0x0F);  // what stands in the buffer is old (choice O-09)
    }
}

// --- words ----------------------------------------------------------------------------------------------------------------
void Drive::write_control_word(std::uint16_t word, Instant now) {
    advance(now);
    if (!running_) return;
    interface_word_ = word;
    compute_control_word(now);
}

/// Per bit, highest first: forced by parameter, control panel, X4 inputs, interface [L276-283].
void Drive::compute_control_word(Instant now) {
    const auto pick = [](std::uint16_t mask, std::uint16_t high, std::uint16_t low) {
        return static_cast<std::uint16_t>((high & mask) | (low & ~mask));
    };
    std::uint16_t word = static_cast<std::uint16_t>(interface_word_ & outside_.copy_mask);
    word = pick(outside_.x4_mask, outside_.x4_word, word);
    word = pick(outside_.panel_mask, outside_.panel_word, word);
    word = pick(setup_.force_mask, setup_.force_word, word);
    // X4.12 is always mapped to bit 1; low for more than half a millisecond, it takes the power [L4398-4401].
    if (sve_low_since_ != never && now >= sve_low_since_ + sve_time) word = static_cast<std::uint16_t>(word & ~0x0002);
    before_ = effective_;
    effective_ = word;
    evaluate(now);
    before_ = effective_;
}

std::uint16_t Drive::status_word() const {
    if (!running_) return 0;
    std::uint16_t s = 0;
    const auto set = [&](int bit, bool on) { s = static_cast<std::uint16_t>(s | (on ? 1u << bit : 0u)); };
    set(0, state_ >= operation_enabled);
    set(1, cw(0));
    set(2, cw(3));
    set(3, state_ == setup_error || state_ == error || (state_ == quick_stop && quick_by_error_));
    set(4, cw(1));
    set(5, cw(2));
    set(6, state_ == not_ready);
    set(7, warn_word() != 0);
    set(8, event_.kind != Event::Kind::none);
    set(9, (state_ >= homing && state_ <= to_initial) || state_ >= to_position);
    set(10, in_target());
    set(11, homed_);
    set(12, fatal_ && (state_ == error || state_ == setup_error));
    set(13, motion_active());
    return s;
}

std::uint16_t Drive::state_var() const {
    if (!running_) return 0;
    std::uint8_t low = sub_;
    if (state_ == error || state_ == setup_error) low = static_cast<std::uint8_t>(error_);
    if (state_ == operation_enabled) {
        low = static_cast<std::uint8_t>((echo_ & 0x0F) | (event_.kind != Event::Kind::none ? 0x10 : 0) | (motion_active() ? 0x20 : 0) |
                                        (in_target() ? 0x40 : 0) | (homed_ ? 0x80 : 0));
    }
    return static_cast<std::uint16_t>(state_ << 8 | low);
}

std::uint16_t Drive::warn_word() const {
    if (!running_) return 0;
    std::uint16_t w = 0;
    const auto set = [&](int bit, bool on) { w = static_cast<std::uint16_t>(w | (on ? 1u << bit : 0u)); };
    const double behind = std::fabs(demand() - actual());
    const double moving_limit = memory.number(0x1473), standing_limit = memory.number(0x1475);
    set(0, outside_.motor_hot);
    set(1, motor_.temperature[0] > 100);
    set(2, static_cast<double>(outside_.motor_supply) < memory.number(0x1018));
    set(3, static_cast<double>(outside_.motor_supply) > memory.number(0x1019));
    set(4, controlled() && moving_limit > 0 && behind > moving_limit / 2);
    set(5, setup_.series == Series::e1100 && controlled() && !motion_active() && standing_limit > 0 && behind > standing_limit / 2);
    set(6, static_cast<double>(ram(0x1BCE)) > memory.number(0x1040));
    set(7, !homed_);
    set(8, hot_for(ptc1_since_, ptc_warn));
    set(9, hot_for(ptc2_since_, ptc_warn));
    set(10, memory.number(0x1C0D) > memory.number(0x1024));
    return w;
}

std::uint32_t Drive::ram(std::uint16_t upid) const {
    switch (upid) {
        case 0x1DB0:
            return last_header_;
        case 0x1B93:
            return static_cast<std::uint32_t>(outside_.current);
        case 0x1BCE: {
            std::uint32_t most = 0;
            for (std::uint16_t u = 0x1BC6; u <= 0x1BCD; ++u)
                most = std::max(most, memory.ram(u));
            return most;
        }
        default:
            return memory.ram(upid);
    }
}

// --- mechanics ------------------------------------------------------------------------------------------------------------
Point Drive::demand_at(Instant now) const {
    if (play_.active) {
        if (const Curve* c = curve_of(play_.curve); c && play_.seconds > 0) {
            const Followed f = c->at(seconds(now - play_.begun) / play_.seconds);
            return {play_.offset + play_.scale * f.position, play_.scale * f.slope / play_.seconds};
        }
    }
    if (follows()) {
        if (const auto f = followed_at(master_.count(now))) return {f->position, f->slope * master_.speed()};
    }
    if (streaming_ && !stream_points_.empty()) {
        const auto& [at, p] = stream_points_.front();
        if (stream_points_.size() > 1 && now > at) {
            const auto& [next_at, q] = stream_points_[1];
            const double period = std::max(1e-9, seconds(next_at - at)), part = std::clamp(seconds(now - at) / period, 0.0, 1.0);
            // With velocities the fine interpolation leaves and meets each set-point with its own (cubic), else it is straight.
            if (stream_velocities_) {
                const double way = q.position - p.position, a = p.velocity * period, b = q.velocity * period;
                const double c2 = 3 * way - 2 * a - b, c3 = a + b - 2 * way;
                return {p.position + part * (a + part * (c2 + part * c3)), (a + part * (2 * c2 + 3 * part * c3)) / period};
            }
            return {p.position + (q.position - p.position) * part, (q.position - p.position) / period};
        }
        return {p.position, 0};
    }
    return profile_.at(now);
}

Point Drive::actual_at(Instant now) const {
    if (!controlled()) return {physical_, 0};
    if (outside_.stall) return {stalled_at_, 0};
    const Point d = demand_at(now);
    return {d.position - offset_ - d.velocity * outside_.lag_ms / 1000, d.velocity};
}

bool Drive::motion_active() const {
    if (!controlled()) return false;
    return play_.active || streaming_ || follows() || !profile_.over(now_);
}

bool Drive::in_target() const {
    constexpr double window = 50;  // 5 um: the parameter has no UPID (choice O-11)
    return controlled() && !motion_active() && std::fabs(profile_.target() - (actual_at(now_).position + offset_)) <= window;
}

// --- errors ---------------------------------------------------------------------------------------------------------------
void Drive::raise(std::uint16_t code, Instant now) {
    if (state_ == error || state_ == setup_error || (state_ == quick_stop && quick_by_error_)) return;  // the first one stays
    error_ = code;
    fatal_ = is_fatal(code);
    if (code == 0x50 || code == 0x51) return enter(setup_error, now);
    // Fatal ones, short circuits, bridge and supply errors cut the power; the others stop the motor first (choice O-20).
    const bool cut = fatal_ || code <= 0x04 || (code >= 0x18 && code <= 0x1E) || (code >= 0x28 && code <= 0x3C);
    if (state_ >= operation_enabled && !cut) {
        quick_by_error_ = true;
        const Point from = demand_at(now);
        play_ = {};
        follow_ = Follow::none;
        streaming_ = indexing_ = false;
        end_table();
        after_.reset();
        state_ = quick_stop;
        sub_ = 0;
        since_ = now;
        profile_.stop(now, from, quick_deceleration());
        return;
    }
    enter(error, now);
}

void Drive::inject(std::uint16_t code, Instant now) {
    advance(now);
    if (running_ && code != 0) raise(code, now);
    evaluate(now);
}

void Drive::move_by_hand(double physical, Instant now) {
    advance(now);
    physical_ = physical;
    stalled_at_ = physical;
    if (!controlled()) profile_.rest(physical_ + offset_, now);
}

void Drive::capture(Instant now) {
    advance(now);
    captured_ = actual();
}

// --- transitions ----------------------------------------------------------------------------------------------------------
void Drive::evaluate(Instant now) {
    if (!running_) return;
    for (int i = 0; i < 32 && transit(now); ++i) {
    }
}

/// One transition; false: it stays.
bool Drive::transit(Instant now) {
    const bool rising_ack = cw(7) && (before_ & 0x80) == 0;
    switch (state_) {
        case not_ready:
            if (!cw(0)) return enter(switch_on_disabled, now), true;
            return false;
        case switch_on_disabled:
            if (cw(1) && cw(2)) return enter(ready_to_switch_on, now), true;
            return false;
        case ready_to_switch_on:
            if (!cw(1) || !cw(2)) return enter(switch_on_disabled, now), true;
            if (cw(0)) return enter(hardware_tests, now), true;
            return false;
        case setup_error:
            if (cw(0)) return enter(error, now), true;
            return false;
        case error: {
            const bool blocked = fatal_ || (error_ == 0x06 && outside_.ptc1_hot) || (error_ == 0x0F && outside_.ptc2_hot) ||
                                 (error_ == 0x20 && outside_.motor_hot);
            if (!rising_ack || blocked) return false;
            before_ = static_cast<std::uint16_t>(before_ | 0x80);  // one edge, one acknowledgement
            error_ = 0;
            enter(not_ready, now);
            check_outside(now);
            return true;
        }
        case hardware_tests:
        case ready_to_operate:
            if (!cw(1) || !cw(2)) return enter(switch_on_disabled, now), true;
            if (!cw(0)) return enter(ready_to_switch_on, now), true;
            if (state_ == ready_to_operate && cw(3)) return enter(operation_enabled, now), check_outside(now), true;
            return false;
        default:
            return transit_enabled(now);
    }
}

bool Drive::transit_enabled(Instant now) {
    const auto rising = [&](int b) { return cw(b) && (before_ >> b & 1) == 0; };
    if (!cw(1)) return enter(switch_on_disabled, now), true;  // OFF2
    if (!cw(0)) return enter(ready_to_switch_on, now), true;  // OFF1
    const auto brake_to = [&](std::uint8_t state) {
        const Point from = demand_at(now);
        frozen_play_ = play_.active || follow_ != Follow::none;
        frozen_motion_ = motion_active();
        frozen_target_ = frozen_play_ ? (vai_ever_ ? target_ : 0.0) : profile_.target();
        frozen_endless_ = !frozen_play_ && profile_.endless();
        frozen_direction_ = from.velocity < 0 ? -1 : 1;
        abort_over_ = never;
        play_ = {};
        follow_ = Follow::none;
        streaming_ = indexing_ = false;
        end_table();
        after_.reset();
        state_ = state;
        sub_ = 0;
        since_ = now;
        profile_.stop(now, from, quick_deceleration());
    };
    if (state_ == quick_stop) return false;  // its end is an event
    if (!cw(2)) {
        quick_by_error_ = false;
        return brake_to(quick_stop), true;  // OFF3
    }
    if (!cw(3)) return enter(ready_to_operate, now), true;
    const auto back = [&] {
        state_ = operation_enabled;
        sub_ = 0;
        since_ = now;
    };
    const auto go = [&](std::uint8_t state, double target, const Ramps& ramps) {
        stop_play(now);
        streaming_ = indexing_ = false;
        state_ = state;
        sub_ = 0;
        since_ = now;
        profile_.move(now, demand_at(now), target, ramps);
        target_ = target;
    };
    const Ramps slow{500'000, 10'000'000, 10'000'000};  // 50 mm/s, 1 m/s2: the drive's own moves have no UPID (choice O-14)
    switch (state_) {
        case operation_enabled:
            if (!cw(4)) {
                brake_to(aborting);
                event_ = {};
                target_ = profile_.target();
                return true;
            }
            if (!cw(5)) return brake_to(freezing), true;
            if (cw(11)) {
                homed_ = false;
                end_table();
                event_ = {};
                go(homing, offset_, slow);  // the reference of these mechanics is their physical zero
                return true;
            }
            if (cw(12)) return go(clearance, memory.number(0x13CA), slow), true;
            if (rising(13)) return go(to_initial, 0, slow), before_ = static_cast<std::uint16_t>(before_ | 0x2000), true;
            if (cw(6)) return go(to_position, 0, slow), true;
            if (cw(8) != cw(9)) {  // both together: no motion (choice O-07)
                const bool plus = cw(8);
                stop_play(now);
                streaming_ = indexing_ = false;
                state_ = plus ? jog_plus : jog_minus;
                sub_ = 1;
                since_ = now;
                profile_.run(now, demand_at(now), plus ? 1 : -1, slow);
                return true;
            }
            if (cw(10) && setup_.series == Series::b1100) return state_ = special, sub_ = 0, since_ = now, true;
            if (cw(15)) return state_ = phase_search, sub_ = 0, since_ = now, true;
            return false;
        case aborting:
            if (!cw(4)) {
                abort_over_ = never;
                return false;
            }
            // With the brake on /Abort the motor goes on when its release has had its time [L4157-4206].
            if (brakes_on_abort() && abort_over_ == never)
                abort_over_ = now + Duration{static_cast<std::int64_t>(memory.number(0x171C) * 1e6)};
            if (brakes_on_abort() && now < abort_over_) return false;
            abort_over_ = never;
            return back(), true;
        case freezing:
            if (!cw(5)) return false;
            back();
            if (frozen_motion_ && frozen_endless_)
                profile_.run(now, demand_at(now), frozen_direction_, last_ramps_);
            else if (frozen_motion_)
                profile_.move(now, demand_at(now), frozen_target_, vai_ever_ ? last_ramps_ : predefined());
            return true;
        case homing:
        case clearance:
        case to_initial:
        case to_position: {
            const int b = state_ == homing ? 11 : state_ == clearance ? 12 : state_ == to_initial ? 13 : 6;
            if (cw(b)) return false;
            const bool done = sub_ == 0x0F;
            back();
            if (!done) stop_motion(quick_deceleration(), now);
            return true;
        }
        case jog_plus:
        case jog_minus:
            if (cw(state_ == jog_plus ? 8 : 9) && !cw(state_ == jog_plus ? 9 : 8)) return false;
            back();
            stop_motion(slow.deceleration, now);
            return true;
        case special:
            if (!cw(10)) return back(), true;
            return false;
        case phase_search:
            if (!cw(15)) return back(), true;
            return false;
        default:
            return false;
    }
}

}  // namespace axisgate::linmot::twin
