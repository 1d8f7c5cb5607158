// The times in this file allow for drives that report late: a position that is reached before the flag says so, and a flag that flickers at
// rest.
#include "gateway/engine/motions.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/engine/clients.hpp"
#include "gateway/engine/loss_of_command.hpp"
#include "gateway/engine/orders.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/streams.hpp"

namespace axisgate::engine {
namespace {
/// A motion that shows neither its end nor movement for this time is over; a program may pause for less.
constexpr Duration rest_ends = std::chrono::seconds(1);
/// Movement without a record that lasts this long is a motion, and not a flicker of the drive's flag.
constexpr Duration found_after = std::chrono::milliseconds(150);
constexpr Duration stop_again = std::chrono::milliseconds(250);

/// Another client may have taken the axis over from the owner while the order was on its way to the drive.
Motion kept(const Axis& a, Motion m, Instant now) {
    if (m.who.door != Door::none && a.authority.held(now) && a.authority.holder() != m.who) m.keeper = a.authority.holder();
    return m;
}
/// Axes of other gateways are guarded by those gateways.
bool is_guarded_elsewhere(const Axis& a) { return a.drive->family.family->uses_dds; }
}  // namespace

std::optional<Motion> Motions::asked(const Axis& a, const CommandBody& body, const Origin& origin) {
    Motion m;
    m.who = AuthorityClient::of(origin);
    m.origin = origin;
    const auto of_move = [&](const Move& move) {
        m.kind = move.kind == Move::Kind::velocity ? Motion::Kind::velocity : Motion::Kind::position;
        m.target = move.target;
        if (move.kind == Move::Kind::relative) {
            const std::int64_t from = a.profile.active_target().value_or(a.profile.feedback().position);
            if (__builtin_add_overflow(from, move.target, &m.target)) m.target = move.target;
        }
        m.velocity = move.velocity.value_or(0);
        m.acceleration = move.acceleration.value_or(0);
        m.deceleration = move.deceleration.value_or(0);
        if (move.hold_ms) m.hold = std::chrono::milliseconds(*move.hold_ms);
    };
    if (const auto* move = std::get_if<Move>(&body)) {
        if (move->prepare_only) return std::nullopt;
        of_move(*move);
    } else if (std::holds_alternative<Home>(body)) {
        m.kind = Motion::Kind::homing;
    } else if (std::holds_alternative<StartTogether>(body)) {
        if (!a.prepared) return std::nullopt;
        of_move(*a.prepared);
    } else if (const Stated stated = Orders::stated(a, body); stated.kind == Stated::Kind::motion) {
        of_move(stated.move);
    } else if (stated.kind == Stated::Kind::homing) {
        m.kind = Motion::Kind::homing;
    } else {
        return std::nullopt;
    }
    return m;
}

void Motions::acknowledged(Axis& a, Motion m, MotionOrder order, std::uint64_t by, std::string_view what, Instant now) {
    if (m.kind != Motion::Kind::stream) streams_.end(a, Reason::interrupted, fmt::format("ended by {}", what), now);
    clients_.supersede(a, by, what);
    m.since = now;
    m.over = m.kind == Motion::Kind::velocity && m.target == 0;
    if (m.hold > Duration::zero()) m.hold_until = now + m.hold;
    a.watch = {a.profile.feedback().position, now, 0};
    a.moves_since = {};
    a.contradicts = false;
    a.at_limit = false;
    a.suspected.reset();
    a.statement.reset();
    if (order == MotionOrder::in_turn) {
        a.stops.wanted.reset();
        a.latch.bits = 0;
    }
    a.homing_why.clear();
    a.motion = kept(a, std::move(m), now);
    a.profile.on_motion(true);
}

void Motions::stop_acknowledged(Axis& a, Stops::Kind kind, Instant now) {
    a.motion.over = true;
    a.motion.hold_until = never;
    a.statement.reset();
    if (a.stops.wanted == kind) a.stops.acknowledged = true;
    if (!a.motion.runs()) a.motion.rested = std::max(a.motion.rested, now);
}

void Motions::suspect(Axis& a, Motion m) { a.suspected = std::move(m); }

void Motions::forget(Axis& a) {
    a.motion = {};
    a.suspected.reset();
    a.statement.reset();
    a.stops.wanted.reset();
    a.moves_since = {};
    a.contradicts = false;
    a.profile.on_motion(false);
}

void Motions::look(Axis& a, Instant now) {
    const AxisFeedback& f = a.profile.feedback();
    if (f.position != a.watch.position) {
        a.watch.position = f.position;
        const double round_s = std::clamp(std::chrono::duration<double>(now - std::exchange(a.watch.since, now)).count(), 0.0, 1.0);
        a.watch.round_s = std::max(round_s, 0.8 * a.watch.round_s);  // the times between reports vary, and a long one may come again
    }
    if (!f.moving && !(f.homing && a.motion.kind == Motion::Kind::homing)) return rests(a, now);
    a.motion.rested = {};
    if (!a.motion.runs()) moves_without_record(a, now);
}

void Motions::rests(Axis& a, Instant now) {
    const AxisFeedback& f = a.profile.feedback();
    Motion& m = a.motion;
    if (m.rested == Instant{}) m.rested = f.at;
    const Duration rest = f.at - std::max(m.rested, m.since);
    const bool told_to_end = a.stops.wanted && a.stops.acknowledged && f.at > a.stops.given_at;
    if (told_to_end || (a.stops.wanted && !a.motions_asked && rest > rest_ends)) a.stops.wanted.reset();
    if (a.suspected && rest > rest_ends) a.suspected.reset();
    if (!m.runs()) {
        a.watch = {f.position, now, 0};  // the next position arrives one report period from here
        a.moves_since = {};
        a.contradicts = m.alarmed = false;
        return;
    }
    if (f.at <= m.since) return;  // the position was read before the drive accepted the order
    const bool powerless = a.profile.state() != PowerState::operation_enabled;
    bool gone = m.over || powerless;
    if (m.kind == Motion::Kind::position) gone = gone || f.target_reached || rest > rest_ends;
    if (m.kind == Motion::Kind::homing) gone = gone || f.homing_attained || f.homing_error || rest > rest_ends;
    if (m.kind == Motion::Kind::stream) gone = gone || (!a.stream.on && rest > rest_ends);
    if (m.kind == Motion::Kind::statement) gone = gone || rest > rest_ends;
    if (m.kind == Motion::Kind::found) gone = true;
    if (!gone) return;
    if (m.kind == Motion::Kind::statement && !m.over && !powerless) a.statement = m;  // the statement may begin to move again
    m = {};
    m.rested = f.at;
    a.moves_since = {};
    a.contradicts = false;
    a.profile.on_motion(false);
    publisher_.publish(a, now);
}

/// The axis moves although no order of this gateway explains it.
void Motions::moves_without_record(Axis& a, Instant now) {
    if (is_guarded_elsewhere(a) || a.motions_asked > 0) return;
    if (a.moves_since == Instant{}) a.moves_since = now;
    // A drive may report movement while its position is being redefined, although the shaft stands.
    const Duration long_enough = a.profile.feedback().velocity == 0 ? rest_ends : found_after;
    if (now - a.moves_since < long_enough && !a.suspected) return;
    Event e;
    e.axis = a.spec.name;
    e.kind = "motion";
    Motion m;
    if (a.suspected) {
        m = *std::exchange(a.suspected, std::nullopt);
        e.severity = Severity::alarm;
        e.text = fmt::format(
            "a motion that {} asked for has begun, although its order was answered as failed or a stop had come after it: it is stopped",
            m.who.text());
    } else if (a.statement) {
        m = *std::exchange(a.statement, std::nullopt);
        m.kind = Motion::Kind::statement;
        m.over = false;
        m.ended_for = LossCause::none;
    } else {
        m.kind = Motion::Kind::found;
    }
    m.since = now;
    a.motion = kept(a, std::move(m), now);
    a.profile.on_motion(true);
    if (!e.text.empty()) {
        publisher_.event(std::move(e), now);
        a.latch.bits = StopLatch::latched | StopLatch::by_fail_safe;
        return orders_.give_own(a, QuickStop{}, now);
    }
    if (a.motion.kind == Motion::Kind::found) loss_.unowned(a, now);
}

bool Motions::hold_on(Axis& a, const Command& c, Instant now) {
    const auto* move = std::get_if<Move>(&c.body);
    if (!move || !move->hold_ms) return false;
    Motion& m = a.motion;
    const bool same = m.kind == Motion::Kind::velocity && !m.over && m.hold_until != never && m.target == move->target &&
                      m.who == AuthorityClient::of(c.origin) && !a.stops.wanted && a.motions_asked == 0 &&
                      a.profile.state() == PowerState::operation_enabled && !a.profile.feedback().fault;
    if (!same) {
        if (!move->renew_only) return false;
        publisher_.refuse(c, Reason::wrong_state,
                          fmt::format("axis {}: there is no held velocity move of this client to renew; it has ended", a.spec.name));
        return true;
    }
    m.hold_until = now + std::chrono::milliseconds(*move->hold_ms);
    Result r;
    r.ticket = c.ticket;
    r.axis = c.axis;
    r.outcome = Outcome::accepted;
    publisher_.answer(r);
    return true;
}

void Motions::check(Axis& a, Instant now) {
    if (now >= a.motion.hold_until) {
        a.motion.hold_until = never;
        Event e;
        e.severity = Severity::warning;
        e.kind = "hold";
        e.axis = a.spec.name;
        e.text = fmt::format("{} has not renewed its velocity move in time: the axis is halted", a.motion.who.text());
        publisher_.event(std::move(e), now);
        orders_.give_own(a, Halt{}, now);
    }
    if (a.stops.wanted && !a.stops.acknowledged && a.stops.of(*a.stops.wanted).order == no_ticket && now - a.stops.given_at >= stop_again &&
        a.drive->answers())
        orders_.stop_again(a, now);
}

}  // namespace axisgate::engine
