#include "adapters/linmot/twin/states.hpp"

#include <algorithm>
#include <array>

namespace axisgate::linmot::twin {
namespace {
constexpr Ramps slow{500'000, 10'000'000, 10'000'000};  // 50 mm/s, 1 m/s2: motions of the drive itself have no UPID (choice O-14)

bool is_fatal(Fault code) noexcept {
    static constexpr std::array<Fault, 9> fatal{0x0A, 0x0D, 0x21, 0x22, 0x45, 0x64, 0x65, 0x67, 0x68};
    return std::ranges::find(fatal, code) != fatal.end();
}
}  // namespace

// --- power ---------------------------------------------------------------------------------------------------------------
void States::start_software(Instant now) {
    running_ = true;
    body_.follower.lose_home();
    error_ = 0;
    fatal_ = false;
    unpower(now);
    enter(not_ready, now);
    word_.start_software();
    if (body_.memory.ram(0x170C) == 0) raise(0x65, now);
    if (const Fault fault = body_.monitor.misconfigured()) raise(fault, now);
    decide(now);
}

void States::stop_software(Instant now) {
    unpower(now);
    running_ = false;
    enter(not_ready, now);
}

void States::unpower(Instant now) {
    body_.follower.keep(now);
    body_.demand.drop(body_.follower.rest(), now);
    body_.armed = {};
    body_.trigger.clear();
    body_.force.end();
    body_.table.end();
    abort_over_ = never;
}

void States::enter(std::uint8_t state, Instant now) {
    const bool was = powered();
    if (was && state < operation_enabled) unpower(now);
    pass_to(state, now);
    if (was == powered()) return;
    body_.follower.control(powered());
    if (!was) {  // the demand is set to the actual position: enabling must not move the axis
        body_.demand.vai().stand(body_.follower.rest(), now);
        body_.buffer.forget(body_.setup.manners.clears_count);
    }
}

void States::pass_to(std::uint8_t state, Instant now, std::uint8_t sub) noexcept {
    state_ = state;
    sub_ = sub;
    since_ = now;
}

// --- control word --------------------------------------------------------------------------------------------------------
void States::write(std::uint16_t word, Instant now) {
    word_.write(word);
    decide(now);
}

void States::decide(Instant now) {
    word_.gather(body_.outside, body_.setup, body_.monitor.unsafe(now));
    evaluate(now);
    word_.seen();
}

// --- errors ---------------------------------------------------------------------------------------------------------------
void States::raise(Fault code, Instant now) {
    if (in_error() || stops_by_error()) return;
    error_ = code;
    fatal_ = is_fatal(code);
    if (code == 0x50 || code == 0x51) return enter(setup_error, now);
    // Fatal errors, short circuits, bridge and supply errors remove the power; the others stop the motor first (choice O-20).
    const bool cut = fatal_ || code <= 0x04 || (code >= 0x18 && code <= 0x1E) || (code >= 0x28 && code <= 0x3C);
    if (!powered() || cut) return enter(error, now);
    by_error_ = true;
    body_.demand.brake(now);
    body_.table.end();
    pass_to(quick_stop, now);
}

void States::check(Instant now) {
    if (!running_) return;
    body_.monitor.warm(now);
    if (const Fault fault = body_.monitor.fault(now)) raise(fault, now);
    // The force is controlled; the model moves no further.
    if (body_.force.reached(static_cast<double>(body_.outside.force))) body_.demand.vai().rest(body_.demand.at(now).position, now);
    limit_switch(now);
}

/// Limit switches count only while the drive is powered and homed; a limit switch clears the home position (E-45).
void States::limit_switch(Instant now) {
    const Outside& o = body_.outside;
    const auto reaction = body_.memory.ram(0x121B);
    if ((!o.limit_in && !o.limit_out) || !powered() || !body_.follower.homed() || reaction == 0) return;
    const Fault code = o.limit_in ? 0x87 : 0x88;
    if (reaction == 1) {
        error_ = code;
        enter(error, now);
    } else {
        raise(code, now);
    }
    body_.follower.lose_home();
}

// --- transitions ----------------------------------------------------------------------------------------------------------
void States::evaluate(Instant now) {
    if (!running_) return;
    for (int i = 0; i < 32 && transit(now); ++i) {
    }
}

/// One transition; false: the state does not change.
bool States::transit(Instant now) {
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
        case error:
            if (!word_.rises(7) || fatal_ || body_.monitor.persists(error_)) return false;
            word_.use_edge(7);  // one edge acknowledges one error
            error_ = 0;
            enter(not_ready, now);
            check(now);
            return true;
        case hardware_tests:
        case ready_to_operate:
            if (!cw(1) || !cw(2)) return enter(switch_on_disabled, now), true;
            if (!cw(0)) return enter(ready_to_switch_on, now), true;
            if (state_ == ready_to_operate && cw(3)) return enter(operation_enabled, now), check(now), true;
            return false;
        default:
            return transit_powered(now);
    }
}

bool States::transit_powered(Instant now) {
    if ((!cw(0) || !cw(1)) && stops_by_error() && body_.setup.keeps_braking_error) {  // the power is removed, the error stays
        by_error_ = false;
        return enter(error, now), true;
    }
    if (!cw(1)) return enter(switch_on_disabled, now), true;  // OFF2
    if (!cw(0)) return enter(ready_to_switch_on, now), true;  // OFF1
    if (state_ == quick_stop) return false;                   // an event ends it
    if (!cw(2)) {
        by_error_ = false;
        return brake_to(quick_stop, now), true;  // OFF3
    }
    if (!cw(3)) return enter(ready_to_operate, now), true;
    switch (state_) {
        case operation_enabled:
            return transit_operating(now);
        case aborting:
            if (!released(now)) return false;
            return pass_to(operation_enabled, now), true;
        case freezing:
            if (!cw(5)) return false;
            pass_to(operation_enabled, now);
            body_.demand.vai().thaw(body_.demand.at(now), now);
            return true;
        case homing:
        case clearance:
        case to_initial:
        case to_position: {
            const int b = state_ == homing ? 11 : state_ == clearance ? 12 : state_ == to_initial ? 13 : 6;
            if (cw(b)) return false;
            const bool done = arrived();
            pass_to(operation_enabled, now);
            if (!done) body_.demand.stop(Interpolator::quick_deceleration, now);
            return true;
        }
        case jog_plus:
        case jog_minus:
            if (cw(state_ == jog_plus ? 8 : 9) && !cw(state_ == jog_plus ? 9 : 8)) return false;
            pass_to(operation_enabled, now);
            body_.demand.stop(slow.deceleration, now);
            return true;
        case special:
        case phase_search:
            if (cw(state_ == special ? 10 : 15)) return false;
            return pass_to(operation_enabled, now), true;
        default:
            return false;
    }
}

/// From "operation enabled": the first bit that requests another state.
bool States::transit_operating(Instant now) {
    if (!cw(4)) {
        brake_to(aborting, now);
        body_.armed = {};
        body_.demand.vai().target_end();
        return true;
    }
    if (!cw(5)) return brake_to(freezing, now), true;
    if (cw(11)) {
        body_.follower.lose_home();
        body_.table.end();
        body_.armed = {};
        // The home reference of these mechanics is their physical zero; on the way upwards its switch closes later by the hysteresis.
        const double zero = body_.follower.offset();
        const bool upwards = body_.demand.at(now).position < zero;
        move_to(homing, zero + (upwards ? static_cast<double>(body_.setup.manners.home_hysteresis) : 0), now);
        return true;
    }
    if (cw(12)) return move_to(clearance, body_.memory.number(0x13CA), now), true;
    if (word_.rises(13)) return move_to(to_initial, 0, now), word_.use_edge(13), true;
    if (cw(6)) return move_to(to_position, 0, now), true;
    if (cw(8) != cw(9)) {  // both at once: no motion (choice O-07)
        pass_to(cw(8) ? jog_plus : jog_minus, now, 1);
        body_.demand.jog(cw(8) ? 1 : -1, slow, now);
        return true;
    }
    if (cw(10) && body_.setup.series == Series::b1100) return pass_to(special, now), true;
    if (cw(15)) return pass_to(phase_search, now), true;
    return false;
}

void States::brake_to(std::uint8_t state, Instant now) {
    abort_over_ = never;
    body_.demand.brake(now);
    body_.table.end();
    pass_to(state, now);
}

void States::move_to(std::uint8_t state, double target, Instant now) {
    pass_to(state, now);
    body_.demand.go(target, slow, now);
}

/// The end of /Abort: after the brake was applied, the motor continues when the release time of the brake is over [L4157-4206].
bool States::released(Instant now) {
    if (cw(4) && brakes_on_abort()) {
        if (abort_over_ == never) abort_over_ = now + Duration{static_cast<std::int64_t>(body_.memory.number(0x171C) * 1e6)};
        if (now < abort_over_) return false;
    }
    abort_over_ = never;
    return cw(4);
}

// --- time -----------------------------------------------------------------------------------------------------------------
Instant States::due(Instant now) const {
    Instant at = body_.monitor.due(now);
    if (state_ == hardware_tests) at = std::min(at, since_ + body_.setup.manners.hardware_test);
    if (state_ == phase_search && !arrived()) at = std::min(at, since_ + search_time);
    if (state_ == aborting && abort_over_ != never) at = std::min(at, abort_over_);
    return at;
}

void States::look(Instant now) {
    if (!body_.monitor.watches() && abort_over_ == never) return;
    check(now);
    decide(now);
}

bool States::finish_test(Instant now) {
    if (state_ == hardware_tests && now >= since_ + body_.setup.manners.hardware_test) {
        enter(ready_to_operate, now);
        evaluate(now);
        return true;
    }
    if (state_ == phase_search && !arrived() && now >= since_ + search_time) {
        sub_ = 0x0F;
        body_.memory.set_ram(0x1C1B, 90);
        return true;
    }
    return false;
}

bool States::awaits_end() const noexcept {
    return !arrived() && (state_ == quick_stop || (state_ >= homing && state_ <= to_initial) || state_ == to_position);
}

Instant States::motion_end() const {
    const Memory& m = body_.memory;
    if (body_.demand.profile().end() == never) return never;
    const bool brake = state_ == quick_stop && m.ram(0x1716) != 0 && m.ram(0x1717) != 0;
    const Duration check = state_ == homing ? body_.setup.manners.homing_check : Duration{};
    return std::max(body_.demand.profile().end(), since_) + (brake ? span_ms(m.number(0x171B)) : check);
}

void States::finish_motion(Instant now) {
    if (state_ != quick_stop) {
        // The mechanical reference is reached: from now on it has the home position.
        if (state_ == homing) body_.demand.vai().stand(body_.follower.home(body_.memory.number(0x13C7), now), now);
        sub_ = 0x0F;
        return;
    }
    enter(by_error_ ? error : switch_on_disabled, now);
    by_error_ = false;
    evaluate(now);
}

}  // namespace axisgate::linmot::twin
