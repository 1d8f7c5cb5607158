// Velocity moves: the dead-man time-out, and the halt before the site's limits of position.
// In: renewals by the client that holds, positions and speeds. Out: halts and events.
// Never sends a renewed move to the drive again.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/engine/orders.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/velocity_moves.hpp"

namespace axisgate::engine {

/// The same velocity move again while it is held: it goes on, and nothing is sent. True: the command has its answer.
bool VelocityMoves::hold_on(Axis& a, const Command& c, Instant now) {
    const auto* m = std::get_if<Move>(&c.body);
    if (!m || !m->hold_ms) return false;
    const bool same = a.held.until != never && a.held.velocity == m->target && a.held.who == AuthorityClient::of(c.origin) &&
                      a.profile.state() == PowerState::operation_enabled && !a.profile.feedback().fault;
    if (!same) {
        if (!m->renew_only) return false;
        publisher_.refuse(c, Reason::wrong_state,
                          fmt::format("axis {}: there is no held velocity move of this client to renew; it has ended", a.spec.name));
        return true;
    }
    a.held.until = now + std::chrono::milliseconds(*m->hold_ms);
    Result r;
    r.ticket = c.ticket;
    r.axis = c.axis;
    r.outcome = Outcome::accepted;
    publisher_.answer(r);
    return true;
}

/// Its time begins when the drive has taken the move: a slow line must not end what it has not begun.
void VelocityMoves::begin_hold(Axis& a, const Move& m, const Origin& origin) {
    a.held = {never, std::chrono::milliseconds(*m.hold_ms), m.target, AuthorityClient::of(origin)};
}

/// Looked at with every housekeeping, so a halt comes at most one of its periods late.
void VelocityMoves::check_hold(Axis& a, Instant now) {
    if (now < a.held.until) return;
    const std::string who = a.held.who.text();
    a.held = {};
    Event e;
    e.severity = Severity::warning;
    e.kind = "hold";
    e.axis = a.spec.name;
    e.text = fmt::format("{} has not renewed its velocity move in time: the axis is halted", who);
    publisher_.event(std::move(e), now);
    orders_.give_own(a, Halt{}, now);
}

/// A velocity move has no target that could be checked beforehand: it is halted so that it comes to rest at the site's limit, as far as its
/// ramp is known: early by that, by the wait for the next position, and by the halt's way down the line, which takes about as long.
void VelocityMoves::check_run(Axis& a, Instant now) {
    const AxisFeedback& f = a.profile.feedback();
    if (f.position != a.run.position) {
        a.run.position = f.position;
        const double round_s = std::clamp(std::chrono::duration<double>(now - std::exchange(a.run.since, now)).count(), 0.0, 1.0);
        a.run.round_s = std::max(round_s, 0.8 * a.run.round_s);  // rounds differ: one that was long may come again
    }
    if (a.run.found && (!f.moving || f.homing)) a.run.found = false, a.run.velocity = 0;
    if (a.run.found) a.run.velocity = f.velocity;
    if (a.run.velocity == 0 || !f.moving) return;
    // A drive may tell its place before its speed: then it is taken to go as it was told.
    const std::int64_t velocity = f.velocity != 0 ? f.velocity : a.run.velocity;
    const bool up = velocity > 0;
    const auto& limit = up ? a.limits.position_max : a.limits.position_min;
    if (!limit) return;
    const double rate = static_cast<double>(a.run.deceleration), reported = std::fabs(static_cast<double>(velocity));
    // While it gains speed it is faster by the time the halt arrives, but never than it was told to go.
    const double gained = reported + 2 * a.run.round_s * static_cast<double>(a.run.acceleration);
    const double speed =
        (a.run.velocity > 0) == up ? std::max(reported, std::min(gained, std::fabs(static_cast<double>(a.run.velocity)))) : reported;
    const double needed = 2 * speed * a.run.round_s + (rate > 0 ? speed * speed / (2 * rate) : 0);
    const double left = static_cast<double>(up ? *limit - f.position : f.position - *limit);
    if (left > needed) return;
    Event e;
    e.severity = Severity::warning;
    e.kind = "limit";
    e.axis = a.spec.name;
    e.text = fmt::format("{} is halted at the axis' {} {}",
                         a.run.found ? "a motion that was under way when the axis was found" : "the velocity move",
                         up ? "position_max" : "position_min", in_unit(*limit, a.limits));
    publisher_.event(std::move(e), now);
    orders_.give_own(a, Halt{}, now);
    a.at_limit = true;
}

}  // namespace axisgate::engine
