// Clients: by what each kind of command is seen to be done.
// In: accepted commands and their axis' feedback. Out: results.
// Never answers from feedback that is older than the acceptance where the end of a motion before could be seen.
#include <fmt/core.h>

#include <cstdlib>

#include "gateway/engine/clients.hpp"
#include "gateway/engine/publisher.hpp"

namespace axisgate::engine {
namespace {
/// A motion that stands still without having arrived has been ended by something else; not at the first look, since a drive may need
/// a moment to get going.
constexpr Duration rest_before_interrupted = std::chrono::milliseconds(250);
constexpr Duration reset_limit = std::chrono::seconds(3);

enum class Progress : std::uint8_t { done, going_on, failed };
}  // namespace

/// Other motions of the axis that somebody still watches end here: a new one takes their place.
void Clients::supersede(Axis& a, std::uint64_t by, std::string_view what) {
    std::vector<std::uint64_t> ended;
    for (const auto number : a.clients) {
        if (number == by) continue;
        const Client& c = *pending_.clients.at(number);
        const bool motion =
            std::holds_alternative<Move>(c.body) || std::holds_alternative<Home>(c.body) || std::holds_alternative<StartTogether>(c.body);
        if (c.accepted && motion) ended.push_back(number);
    }
    for (const auto number : ended) {
        Result r;
        r.outcome = Outcome::failed;
        r.reason = Reason::interrupted;
        r.text = fmt::format("axis {}: ended by {}", a.spec.name, what);
        finish(number, std::move(r));
    }
}

/// Looks at every command of the axis that was accepted and asked to be answered when done (or needs no drive to be done).
void Clients::track(Axis& a, Instant now) {
    if (a.clients.empty()) return;
    const AxisFeedback& f = a.profile.feedback();
    const bool online = a.drive->serving == Presence::twin ? a.drive->twin_online : a.drive->device_online;
    const auto watched = a.clients;  // finish() changes the list
    for (const auto number : watched) {
        const auto it = pending_.clients.find(number);
        if (it == pending_.clients.end() || !it->second->accepted) continue;
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
            finish(number, std::move(r));
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
                const Axis* x = machine_.axis(id);
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
        finish(number, std::move(r));
    }
    // More watchers than the bound cannot gather: the oldest one is told so.
    while (a.clients.size() > max_clients_per_axis) {
        Result r;
        r.outcome = Outcome::failed;
        r.reason = Reason::busy;
        r.text = fmt::format("axis {}: too many commands are being watched; this one went on without a watcher", a.spec.name);
        finish(a.clients.front(), std::move(r));
    }
}

void Clients::finish(std::uint64_t number, Result r) {
    const auto it = pending_.clients.find(number);
    if (it == pending_.clients.end()) return;
    r.ticket = it->second->ticket;
    r.axis = it->second->axis;
    if (Axis* a = machine_.axis(r.axis)) std::erase(a->clients, number);
    pending_.clients.erase(it);
    if (r.ticket != no_ticket) publisher_.answer(r);
}

}  // namespace axisgate::engine
