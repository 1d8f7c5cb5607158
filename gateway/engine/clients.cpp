// Recognizes the end of each kind of command in the feedback of its axis. Feedback that is older than the drive's acceptance is not used
// where it could still show the end of the previous motion.
#include <fmt/core.h>

#include <cstdlib>
#include <utility>

#include "gateway/engine/clients.hpp"
#include "gateway/engine/publisher.hpp"

namespace axisgate::engine {
namespace {
/// A motion that stands still before its target was ended by something else. The first feedback after the start does not count, because a
/// drive may need a moment to begin to move.
constexpr Duration rest_before_interrupted = std::chrono::milliseconds(250);
/// From standstill until a drive shows that it has reached its target: the window's time is a setting of the drive.
constexpr Duration longest_settling = std::chrono::milliseconds(2500);
constexpr Duration reset_limit = std::chrono::seconds(3);

/// The observed progress of a command whose end is watched, with the reason if it has failed.
struct Progress {
    enum class Kind : std::uint8_t { done, going_on, failed } kind = Kind::going_on;
    Reason reason = Reason::none;
    std::string text;
};
const Progress done{Progress::Kind::done, Reason::none, {}}, going_on;

template <class... Args>
Progress failed(Reason reason, fmt::format_string<Args...> text, Args&&... args) {
    return {Progress::Kind::failed, reason, fmt::format(text, std::forward<Args>(args)...)};
}

Progress in_fault(const Axis& a) {
    return failed(Reason::interrupted, "axis {}: fault, drive's code {}", a.spec.name, a.profile.feedback().error_code);
}

Progress not_enabled(const Axis& a) { return failed(Reason::interrupted, "axis {} is {} now", a.spec.name, name_of(a.profile.state())); }

/// It rests and says nothing of its target. A drive may show that it is in position some time after the standstill.
bool has_stopped(const Axis& a, Instant accepted_at) {
    return a.rests_from && a.profile.feedback().at - std::max(*a.rests_from, accepted_at) > longest_settling;
}
bool rests_since(const AxisFeedback& f, Instant accepted_at) { return !f.moving && f.at - accepted_at > rest_before_interrupted; }

Progress of_motion(const Axis& a, Instant accepted_at) {
    const AxisFeedback& f = a.profile.feedback();
    if (f.fault) return in_fault(a);
    if (f.target_reached && !f.moving) return done;
    if (a.profile.state() != PowerState::operation_enabled) return not_enabled(a);
    if (has_stopped(a, accepted_at))
        return failed(Reason::interrupted, "axis {} has stopped before its target (at {} increments)", a.spec.name, f.position);
    return going_on;
}

Progress of_velocity(const Axis& a, const Move& move, Instant accepted_at) {
    const AxisFeedback& f = a.profile.feedback();
    if (f.fault) return in_fault(a);
    if (a.profile.state() != PowerState::operation_enabled) return not_enabled(a);
    const bool reached = f.at > accepted_at && std::llabs(f.velocity - move.target) * 100 <= std::llabs(move.target);
    return reached ? done : going_on;
}

Progress of_homing(const Axis& a, Instant accepted_at) {
    const AxisFeedback& f = a.profile.feedback();
    if (f.homing_error && a.homing_why.empty())
        return failed(Reason::interrupted, "axis {}: homing ended with an error, drive's code {}", a.spec.name, f.error_code);
    if (f.homing_error) return failed(Reason::interrupted, "axis {}: {}", a.spec.name, a.homing_why);
    if (f.homing_attained && !f.moving && !f.homing) return done;
    if (f.fault) return failed(Reason::interrupted, "axis {}: fault during homing, drive's code {}", a.spec.name, f.error_code);
    if (!f.homing && rests_since(f, accepted_at))
        return failed(Reason::interrupted, "axis {}: homing has stopped before its end", a.spec.name);
    return going_on;
}

Progress of_enabling(const Axis& a) {
    if (a.profile.state() == PowerState::operation_enabled) return done;
    return a.profile.feedback().fault ? in_fault(a) : going_on;
}

Progress of_reset(const Axis& a, Duration waited) {
    const AxisFeedback& f = a.profile.feedback();
    if (!f.fault) return done;
    if (waited <= reset_limit) return going_on;
    return failed(Reason::wrong_state, "axis {}: the fault (drive's code {}) is still there; remove its cause first", a.spec.name,
                  f.error_code);
}

Progress of_standstill(const Axis& a, Instant accepted_at) {
    const AxisFeedback& f = a.profile.feedback();
    if (f.fault) return in_fault(a);
    return !f.homing && rests_since(f, accepted_at) ? done : going_on;
}

/// A command of the drive's catalogue whose end the axis shows.
Progress of_action(const Axis& a, const Client& c, Completion completes) {
    const AxisFeedback& f = a.profile.feedback();
    if (completes == Completion::powered) return of_enabling(a);
    if (completes == Completion::standstill) return of_standstill(a, c.accepted_at);
    // Until the motion has begun, the axis still shows the end of the previous one.
    const bool begun = c.was_moving || f.fault || f.at - c.accepted_at > rest_before_interrupted;
    return begun ? of_motion(a, c.accepted_at) : going_on;
}

bool is_online(const Axis& a) { return a.drive->serving == Presence::twin ? a.drive->twin_online : a.drive->device_online; }

template <class... Bodies>
bool is_any_of(const CommandBody& body) {
    return (std::holds_alternative<Bodies>(body) || ...);
}

/// The start is done when all axes have arrived, and has failed when the first of them fails.
Progress of_start_together(const Machine& machine, const StartTogether& together, Instant accepted_at) {
    bool all = true;
    for (const AxisId id : together.axes) {
        const Axis* x = machine.axis(id);
        if (!x) continue;
        Progress one = of_motion(*x, accepted_at);
        if (one.kind == Progress::Kind::failed) return one;
        all = all && one.kind == Progress::Kind::done;
    }
    return all ? done : going_on;
}

/// Derives the progress of a command whose client waits for its end from the feedback of the axis.
Progress progress_of(const Machine& machine, const Axis& a, const Client& c, Completion completes, Instant now) {
    const AxisFeedback& f = a.profile.feedback();
    const bool online = is_online(a), fresh = f.at > c.accepted_at;
    if (completes == Completion::online_again) return c.was_silent && online && fresh ? done : going_on;
    if (!online && !std::holds_alternative<ProcessData>(c.body))
        return failed(Reason::no_answer, "axis {}: the drive went silent; whether it has finished is not known", a.spec.name);
    if (std::holds_alternative<Action>(c.body)) return of_action(a, c, completes);
    if (std::holds_alternative<Enable>(c.body)) return of_enabling(a);
    if (std::holds_alternative<Disable>(c.body)) return f.power == AxisFeedback::Power::off ? done : going_on;
    if (is_any_of<Halt, QuickStop>(c.body)) return fresh && !f.moving ? done : going_on;
    if (std::holds_alternative<ResetFault>(c.body)) return of_reset(a, now - c.accepted_at);
    if (std::holds_alternative<Home>(c.body)) return of_homing(a, c.accepted_at);
    if (const auto* together = std::get_if<StartTogether>(&c.body)) return of_start_together(machine, *together, c.accepted_at);
    const auto* move = std::get_if<Move>(&c.body);
    // Parameters, native exchanges, set-points written as process data and prepared moves are done when the drive has acknowledged them.
    if (!move || move->prepare_only) return done;
    return move->kind == Move::Kind::velocity ? of_velocity(a, *move, c.accepted_at) : of_motion(a, c.accepted_at);
}

/// The command's result, as soon as there is one: the drive's answer, corrected by the observed state of the axis.
std::optional<Result> result_of(const Machine& machine, const Axis& a, Client& c, Instant now) {
    const AxisFeedback& f = a.profile.feedback();
    const auto* action = std::get_if<Action>(&c.body);
    const CatalogueCommand* listed = action ? a.drive->catalogue->command(action->name) : nullptr;
    const Completion completes = listed ? listed->completes : Completion::acknowledged;
    if (completes == Completion::online_again && !is_online(a)) c.was_silent = true;
    c.was_moving = c.was_moving || (f.at > c.accepted_at && f.moving);
    const bool by_axis = completes != Completion::acknowledged && completes != Completion::reported;
    // The end of these commands is observed at the axis, so the adapter's `done` only means that the drive has acknowledged the command.
    if (by_axis) c.result.outcome = Outcome::accepted;
    if (action && (!by_axis || !c.until_done)) {
        if (completes == Completion::acknowledged) c.result.outcome = Outcome::done;
        return c.result;
    }
    Progress progress = c.until_done ? progress_of(machine, a, c, completes, now) : done;
    if (progress.kind == Progress::Kind::going_on) return std::nullopt;
    Result r = c.result;
    if (progress.kind == Progress::Kind::failed) {
        r.outcome = Outcome::failed;
        r.reason = progress.reason;
        r.code = f.error_code;
        r.text = std::move(progress.text);
    } else {
        // A command that the drive has only accepted is not done, even if its adapter reports it as done.
        r.outcome = c.until_done || !is_any_of<Move, Home, Halt, QuickStop, StartTogether>(c.body) ? Outcome::done : Outcome::accepted;
    }
    return r;
}
}  // namespace

/// Other motions of the axis that are still being watched end here, because a new one replaces them.
void Clients::supersede(Axis& a, std::uint64_t by, std::string_view what) {
    std::vector<std::uint64_t> ended;
    for (const auto number : a.clients) {
        if (number == by) continue;
        const Client& c = *pending_.clients.at(number);
        if (c.accepted && is_any_of<Move, Home, StartTogether>(c.body)) ended.push_back(number);
    }
    for (const auto number : ended) {
        Result r;
        r.outcome = Outcome::failed;
        r.reason = Reason::interrupted;
        r.text = fmt::format("axis {}: ended by {}", a.spec.name, what);
        finish(number, std::move(r));
    }
}

/// Examines every accepted command of the axis whose client waits for its end, or whose end does not depend on the drive.
void Clients::track(Axis& a, Instant now) {
    const auto watched = a.clients;  // finish() changes the list
    for (const auto number : watched) {
        const auto it = pending_.clients.find(number);
        if (it == pending_.clients.end() || !it->second->accepted) continue;
        if (auto result = result_of(machine_, a, *it->second, now)) finish(number, *std::move(result));
    }
    // If more commands are watched than the bound allows, the oldest one is answered with this reason.
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
