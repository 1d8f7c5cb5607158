// Engine, watching motions until they are done, interrupted or lost; group starts; the stop of everything.
// In: the profiles' feedback. Out: the one result of commands that asked to be answered when done.
// Never takes silence for success: what nobody saw end is reported as failed or goes on being watched.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "gateway/engine/engine.hpp"
#include "gateway/engine/engine_parts.hpp"
#include "gateway/engine/flight_record.hpp"

namespace axisgate {
namespace {
/// A motion that stands still without having arrived has been ended by something else; not at the first look, since a drive may need
/// a moment to get going.
constexpr Duration rest_before_interrupted = std::chrono::milliseconds(250);
constexpr Duration reset_limit = std::chrono::seconds(3);

enum class Progress : std::uint8_t { done, going_on, failed };
}  // namespace

/// Other motions of the axis that somebody still watches end here: a new one takes their place.
void Engine::supersede(Axis& a, std::uint64_t by, std::string_view what, Instant now) {
    std::vector<std::uint64_t> ended;
    for (const auto number : a.clients) {
        if (number == by) continue;
        const Client& c = *clients_.at(number);
        const bool motion =
            std::holds_alternative<Move>(c.body) || std::holds_alternative<Home>(c.body) || std::holds_alternative<StartTogether>(c.body);
        if (c.accepted && motion) ended.push_back(number);
    }
    for (const auto number : ended) {
        Result r;
        r.outcome = Outcome::failed;
        r.reason = Reason::interrupted;
        r.text = fmt::format("axis {}: ended by {}", a.spec.name, what);
        finish(number, std::move(r), now);
    }
}

/// Looks at every command of the axis that was accepted and asked to be answered when done (or needs no drive to be done).
void Engine::track(Axis& a, Instant now) {
    if (a.clients.empty()) return;
    const AxisFeedback& f = a.profile.feedback();
    const bool online = a.drive->serving == Presence::twin ? a.drive->twin_online : a.drive->device_online;
    const auto watched = a.clients;  // finish() changes the list
    for (const auto number : watched) {
        const auto it = clients_.find(number);
        if (it == clients_.end() || !it->second->accepted) continue;
        Client& c = *it->second;
        const bool fresh = f.at > c.accepted_at;
        Progress progress = Progress::going_on;
        Reason reason = Reason::interrupted;
        std::string text;
        const auto fail = [&](Reason why, std::string t) {
            progress = Progress::failed;
            reason = why;
            text = std::move(t);
        };
        const auto watch_motion = [&](const Axis& x) {
            const AxisFeedback& g = x.profile.feedback();
            if (g.fault) {
                fail(Reason::interrupted, fmt::format("axis {}: fault, drive's code {}", x.spec.name, g.error_code));
            } else if (g.target_reached && !g.moving) {
                progress = Progress::done;
            } else if (x.profile.state() != PowerState::operation_enabled) {
                fail(Reason::interrupted, fmt::format("axis {} is {} now", x.spec.name, name_of(x.profile.state())));
            } else if (!g.moving && g.at - c.accepted_at > rest_before_interrupted) {
                fail(Reason::interrupted, fmt::format("axis {} has stopped before its target (at {} increments)", x.spec.name, g.position));
            }
        };
        const auto* action = std::get_if<Action>(&c.body);
        const CatalogueCommand* listed = action ? a.drive->catalogue->command(action->name) : nullptr;
        const Completion completes = listed ? listed->completes : Completion::acknowledged;
        if (completes == Completion::online_again && !online) c.was_silent = true;
        c.was_moving = c.was_moving || (fresh && f.moving);
        const bool by_axis = completes != Completion::acknowledged && completes != Completion::reported;
        // What the axis shows is not the adapter's to tell: its `done` is the drive's acknowledgement then.
        if (by_axis) c.result.outcome = Outcome::accepted;
        if (action && (!by_axis || !c.until_done)) {
            if (completes == Completion::acknowledged) c.result.outcome = Outcome::done;
            Result r = c.result;
            finish(number, std::move(r), now);
            continue;
        }
        if (!c.until_done) {
            progress = Progress::done;
        } else if (completes == Completion::online_again) {
            if (c.was_silent && online && fresh) progress = Progress::done;
        } else if (!online && !std::holds_alternative<ProcessData>(c.body)) {
            fail(Reason::no_answer, fmt::format("axis {}: the drive went silent; whether it has finished is not known", a.spec.name));
        } else if (completes == Completion::target_reached) {
            // Before it has begun, the axis shows the end of the motion before.
            if (c.was_moving || f.fault || f.at - c.accepted_at > rest_before_interrupted) watch_motion(a);
        } else if (completes == Completion::standstill) {
            if (f.fault) {
                fail(Reason::interrupted, fmt::format("axis {}: fault, drive's code {}", a.spec.name, f.error_code));
            } else if (!f.moving && !f.homing && f.at - c.accepted_at > rest_before_interrupted) {
                progress = Progress::done;
            }
        } else if (std::holds_alternative<Enable>(c.body) || completes == Completion::powered) {
            if (a.profile.state() == PowerState::operation_enabled) {
                progress = Progress::done;
            } else if (f.fault) {
                fail(Reason::interrupted, fmt::format("axis {}: fault, drive's code {}", a.spec.name, f.error_code));
            }
        } else if (std::holds_alternative<Disable>(c.body)) {
            if (f.power == AxisFeedback::Power::off) progress = Progress::done;
        } else if (std::holds_alternative<Halt>(c.body) || std::holds_alternative<QuickStop>(c.body)) {
            if (fresh && !f.moving) progress = Progress::done;
        } else if (std::holds_alternative<ResetFault>(c.body)) {
            if (!f.fault) {
                progress = Progress::done;
            } else if (now - c.accepted_at > reset_limit) {
                fail(Reason::wrong_state,
                     fmt::format("axis {}: the fault (drive's code {}) is still there; remove its cause first", a.spec.name, f.error_code));
            }
        } else if (std::holds_alternative<Home>(c.body)) {
            if (f.homing_error) {
                fail(Reason::interrupted,
                     a.homing_why.empty() ? fmt::format("axis {}: homing ended with an error, drive's code {}", a.spec.name, f.error_code)
                                          : fmt::format("axis {}: {}", a.spec.name, a.homing_why));
            } else if (f.homing_attained && !f.moving && !f.homing) {
                progress = Progress::done;
            } else if (f.fault) {
                fail(Reason::interrupted, fmt::format("axis {}: fault during homing, drive's code {}", a.spec.name, f.error_code));
            } else if (!f.moving && !f.homing && f.at - c.accepted_at > rest_before_interrupted) {
                fail(Reason::interrupted, fmt::format("axis {}: homing has stopped before its end", a.spec.name));
            }
        } else if (const auto* move = std::get_if<Move>(&c.body)) {
            if (move->prepare_only) {
                progress = Progress::done;
            } else if (move->kind == Move::Kind::velocity) {
                if (f.fault) {
                    fail(Reason::interrupted, fmt::format("axis {}: fault, drive's code {}", a.spec.name, f.error_code));
                } else if (a.profile.state() != PowerState::operation_enabled) {
                    fail(Reason::interrupted, fmt::format("axis {} is {} now", a.spec.name, name_of(a.profile.state())));
                } else if (fresh && std::llabs(f.velocity - move->target) * 100 <= std::llabs(move->target)) {
                    progress = Progress::done;
                }
            } else {
                watch_motion(a);
            }
        } else if (const auto* together = std::get_if<StartTogether>(&c.body)) {
            bool all = true;
            for (const AxisId id : together->axes) {
                const Axis* x = axis(id);
                if (!x) continue;
                progress = Progress::going_on;
                watch_motion(*x);
                if (progress == Progress::failed) break;
                all = all && progress == Progress::done;
            }
            if (progress != Progress::failed) progress = all ? Progress::done : Progress::going_on;
        } else {
            progress = Progress::done;  // parameters, native exchanges, set-points written as process data: done when taken
        }
        if (progress == Progress::going_on) continue;
        Result r = c.result;
        if (progress == Progress::failed) {
            r.outcome = Outcome::failed;
            r.reason = reason;
            r.code = f.error_code;
            r.text = std::move(text);
        } else {
            const bool is_motion = std::holds_alternative<Move>(c.body) || std::holds_alternative<Home>(c.body) ||
                                   std::holds_alternative<Halt>(c.body) || std::holds_alternative<QuickStop>(c.body) ||
                                   std::holds_alternative<StartTogether>(c.body);
            // Whatever its adapter calls it: what was merely taken is not done.
            r.outcome = c.until_done || !is_motion ? Outcome::done : Outcome::accepted;
        }
        finish(number, std::move(r), now);
    }
    // More watchers than the bound cannot gather: the oldest one is told so.
    while (a.clients.size() > max_clients_per_axis) {
        Result r;
        r.outcome = Outcome::failed;
        r.reason = Reason::busy;
        r.text = fmt::format("axis {}: too many commands are being watched; this one went on without a watcher", a.spec.name);
        finish(a.clients.front(), std::move(r), now);
    }
}

/// The same velocity move again while it is held: it goes on, and nothing is sent. True: the command has its answer.
bool Engine::hold_on(Axis& a, const Command& c, Instant now) {
    const auto* m = std::get_if<Move>(&c.body);
    if (!m || !m->hold_ms) return false;
    const bool same = a.held.until != never && a.held.velocity == m->target && a.held.who == AuthorityClient::of(c.origin) &&
                      a.profile.state() == PowerState::operation_enabled && !a.profile.feedback().fault;
    if (!same) {
        if (!m->renew_only) return false;
        refuse(c, Reason::wrong_state,
               fmt::format("axis {}: there is no held velocity move of this client to renew; it has ended", a.spec.name));
        return true;
    }
    a.held.until = now + std::chrono::milliseconds(*m->hold_ms);
    Result r;
    r.ticket = c.ticket;
    r.axis = c.axis;
    r.outcome = Outcome::accepted;
    answer(r);
    return true;
}

/// Its time begins when the drive has taken the move: a slow line must not end what it has not begun.
void Engine::begin_hold(Axis& a, const Move& m, const Origin& origin) {
    a.held = {never, std::chrono::milliseconds(*m.hold_ms), m.target, AuthorityClient::of(origin)};
}

/// Looked at with every housekeeping, so a halt comes at most one of its periods late.
void Engine::check_hold(Axis& a, Instant now) {
    if (now < a.held.until) return;
    const std::string who = a.held.who.text();
    a.held = {};
    Event e;
    e.severity = Severity::warning;
    e.kind = "hold";
    e.axis = a.spec.name;
    e.text = fmt::format("{} has not renewed its velocity move in time: the axis is halted", who);
    event(std::move(e), now);
    auto decision = a.profile.on_command(Halt{});
    for (auto& o : decision.orders)
        give_order(a, nullptr, std::move(o), {}, now);
}

/// A velocity move has no target that could be checked beforehand: it is halted so that it comes to rest at the site's limit, as far as its
/// ramp is known: early by that, by the wait for the next position, and by the halt's way down the line, which takes about as long.
void Engine::check_run(Axis& a, Instant now) {
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
    const double rate = static_cast<double>(a.run.deceleration), told = std::fabs(static_cast<double>(velocity));
    // While it gains speed it is faster by the time the halt arrives, but never than it was told to go.
    const double gained = told + 2 * a.run.round_s * static_cast<double>(a.run.acceleration);
    const double speed =
        (a.run.velocity > 0) == up ? std::max(told, std::min(gained, std::fabs(static_cast<double>(a.run.velocity)))) : told;
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
    event(std::move(e), now);
    auto decision = a.profile.on_command(Halt{});
    for (auto& o : decision.orders)
        give_order(a, nullptr, std::move(o), {}, now);
    a.at_limit = true;
}

void Engine::shut_down(Instant now) {
    if (tap_) tap_->shut_down(now);
    now_ = std::max(now_, now);
    if (closing_) return;
    for (auto& a : axes_) {
        if (!a || a->drive->serving == Presence::offline) continue;
        a->loss = LossCause::none;  // whatever was lost before: this is the last that can be done
        fail_safe(*a, LossCause::gateway_ends, now);
    }
    closing_ = true;
}

}  // namespace axisgate
