// Events that are due are carried out in order, each at its own instant.
#include "adapters/linmot/twin/drive.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::linmot::twin {

// --- power ---------------------------------------------------------------------------------------------------------------
void Drive::power_on(Instant now) {
    memory.restart();
    states_.power_on();
    commands_.power_on();
    body_.buffer.power_on(body_.setup.manners.first_count);
    body_.follower.power_on();
    body_.demand.vai().power_on();
    body_.demand.coupling().power_on();
    body_.master.power_on();
    body_.monitor.power_on(now);
    start_software(now);
}

void Drive::stop_software(Instant now) {
    advance(now);
    states_.stop_software(now);
}

void Drive::start_software(Instant now) {
    now_ = now;
    states_.start_software(now);
}

// --- from the line -------------------------------------------------------------------------------------------------------
void Drive::write_control_word(std::uint16_t word, Instant now) {
    advance(now);
    if (states_.running()) states_.write(word, now);
}

void Drive::write_motion_command(std::span<const std::uint8_t> bytes, Instant now) {
    advance(now);
    if (states_.running() && bytes.size() >= 2) commands_.write(bytes, now);
}

// --- the hand ------------------------------------------------------------------------------------------------------------
void Drive::set_outside(const Outside& outside, Instant now) {
    advance(now);
    body_.demand.step_coupling(now);
    body_.monitor.warm(now);
    if (outside.stall && !body_.outside.stall) body_.follower.hold(now);
    const bool moved = outside.encoder != body_.outside.encoder;
    body_.master.set(moved ? static_cast<double>(outside.encoder) : body_.master.edges(now), static_cast<double>(outside.encoder_speed),
                     now);
    body_.monitor.seen(outside, now);
    if (outside.current != body_.outside.current) {
        current_from_ = shown_current();
        current_since_ = now;
    }
    body_.outside = outside;
    body_.monitor.show_temperatures();
    body_.demand.step_coupling(now);
    states_.check(now);
    body_.demand.step_index(now);
    states_.decide(now);
    now_ = now;
}

void Drive::trigger(bool rising, Instant now) {
    advance(now);
    if (body_.trigger.edge(rising, states_.running(), now)) commands_.edge(rising, now);
}

void Drive::capture(Instant now) {
    advance(now);
    body_.follower.capture(now);
}

void Drive::move_by_hand(double physical, Instant now) {
    advance(now);
    body_.follower.push(physical, now);
    if (!states_.powered()) body_.demand.vai().rest(body_.follower.rest(), now);
}

void Drive::inject(std::uint16_t code, Instant now) {
    advance(now);
    if (states_.running() && code != 0) states_.raise(code, now);
    states_.evaluate(now);
}

/// The current that 1B93h shows rises and falls evenly from the value before its last change.
double Drive::shown_current() const {
    const auto to = static_cast<double>(body_.outside.current);
    const double rise = seconds(body_.setup.manners.current_rise);
    return rise <= 0 ? to : to + (current_from_ - to) * std::max(0.0, 1 - seconds(now_ - current_since_) / rise);
}

std::uint32_t Drive::ram(std::uint16_t upid) const {
    if (upid == 0x1B8D) return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(std::clamp(actual(), -2e9, 2e9))));
    if (upid != 0x1B93) return body_.ram(upid);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(shown_current())));
}

// --- time ----------------------------------------------------------------------------------------------------------------
void Drive::advance(Instant now) {
    if (now < now_) return;
    // Bounded: a table that loops without a wait needs one cycle per entry, and next_event() makes the calls frequent enough.
    for (int i = 0; i < 100'000; ++i) {
        const Instant at = due();
        const bool watched = states_.running() && states_.powered() && !states_.stops_by_error();
        const Instant lags = body_.follower.advance(std::clamp(at, now_, now), watched);
        if (lags == never && at > now) break;
        now_ = std::max(now_, std::min(at, lags));
        handle(now_);
    }
    now_ = now;
    body_.follower.advance(now);
}
/// Words change at events, at the end of a motion, and while it settles or another source than the interpolator leads.
Instant Drive::words_due(Duration look) const {
    const Demand& demand = body_.demand;
    const bool moves = demand.moves(now_);
    const bool looks = body_.monitor.watches() || (states_.powered() && (moves ? demand.led() : body_.follower.swings(now_)));
    const Instant end = states_.powered() && moves && !demand.led() ? demand.profile().end() : never;
    return std::min({due(), end, looks ? now_ + look : never});
}

Instant Drive::due() const {
    if (!states_.running()) return never;
    const Demand& demand = body_.demand;
    Instant at = never;
    const auto take = [&](Instant t) { at = std::min(at, std::max(t, now_)); };
    take(states_.due(now_));
    if (!states_.powered()) return at;
    take(demand.coupling().due(now_));
    if (demand.indexes() && body_.outside.encoder_speed != 0) take(now_ + watch_step);
    if (demand.curve_end() != never)
        take(demand.curve_end());
    else if (!demand.led() && (demand.vai().queued() || states_.awaits_end()))
        take(states_.motion_end());
    if (states_.state() == operation_enabled && body_.armed.crossing()) {
        const bool upwards = body_.armed.kind == Armed::Kind::upwards;
        take(demand.profile().crossing(body_.armed.position, upwards, now_).value_or(never));
    }
    if (!states_.stops_by_error()) take(std::min(body_.follower.lag_limit(now_, now_), body_.follower.range_limit(now_, now_)));
    if (demand.stream().active()) take(demand.stream().due());
    take(body_.trigger.due());
    if (body_.table.runs()) {
        const Instant end = demand.led() || demand.profile().endless() ? never : demand.profile().end() + Duration{1};
        take(body_.table.due(now_, end));
    }
    return at;
}

Instant Drive::next_event() const {
    // Changes without an effect outside need no wake-up except to keep the catching up short. This is called after every telegram of the
    // line, so it must be fast.
    if (!states_.running() || (!body_.table.runs() && !body_.demand.stream().active())) return never;
    const Instant at = due();
    return at == never ? never : std::max(at, now_ + std::chrono::milliseconds(50));
}

/// For limits and crossings, the instant is the first nanosecond after them.
Fault Drive::limit_passed(Instant now) const {
    if (states_.stops_by_error()) return 0;
    const Instant before = now - Duration{2};
    if (body_.follower.lag_limit(now, before) <= now) return states_.moves(now) || body_.setup.series == Series::b1100 ? 0x0B : 0x0C;
    if (body_.follower.range_limit(now, before) <= now) return body_.demand.profile().at(now).velocity > 0 ? 0x08 : 0x07;
    return 0;
}

bool Drive::crossed(Instant now) const {
    if (states_.state() != operation_enabled || !body_.armed.crossing()) return false;
    const bool upwards = body_.armed.kind == Armed::Kind::upwards;
    const auto t = body_.demand.profile().crossing(body_.armed.position, upwards, now - Duration{2});
    return t && *t <= now;
}

void Drive::handle(Instant now) {
    Demand& demand = body_.demand;
    states_.look(now);
    demand.step_coupling(now);
    if (states_.finish_test(now) || !states_.powered()) return;
    if (const Fault fault = limit_passed(now)) return states_.raise(fault, now);
    if (crossed(now)) return commands_.fire(now);
    if (const auto rising = body_.trigger.take(now)) return commands_.edge(*rising, now);
    if (body_.outside.encoder_speed != 0) demand.step_index(now);
    if (demand.pass(now)) return;
    if (const Fault fault = demand.starve(now)) return states_.raise(fault, now);
    if (now >= demand.curve_end()) return demand.leave(now);
    if (!demand.moves(now) && now >= states_.motion_end()) {
        if (states_.awaits_end()) return states_.finish_motion(now);
        if (demand.vai().queued() && !states_.arrived()) return commands_.start_queued(now);
    }
    commands_.step_table(now);
}

}  // namespace axisgate::linmot::twin
