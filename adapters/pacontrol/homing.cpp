// Verbs, part homing: the control's own reference run, of one axis and of several one after the other.
// In: home, the action `reference`; ends of processing. Out: 0A84, 0A96; then 190C and 1934: the position has a new zero.
// Never calls an axis referenced that its own flag does not show as such, where the control has the flag.
#include <fmt/core.h>

#include <cstdlib>
#include <utility>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr int first_of_watch = 10;                                // steps: 10 the position, 11 the flag, 12 the status
constexpr Duration watch_period = std::chrono::milliseconds(40);  // between two looks
constexpr std::int64_t noise_limit = 20;                          // increments by which an axis at rest may seem to move
constexpr Duration rest_limit = std::chrono::milliseconds(1500);  // without any sign of the run it has ended
}  // namespace

void Homing::run(Axis& a, const Reply* reply, Turn& t) {
    if (a.job.kind == Job::Kind::home) return run_home(a, reply, t);
    if (reply) run_several(a, *reply, t);
}

/// A run that has begun and did not come to its end. What ended it is the result, and an event: the command may have its result long
/// since.
void Homing::aborted(Axis& a, std::string text, std::int32_t code, Turn& t) {
    const Reason reason = drive_.in_trouble() || drive_.what_ended(a).empty() ? Reason::drive_refused : Reason::interrupted;
    a.running = false;
    feedback_.end_motion(a, false, reason, text, t);
    a.fb.homing_attained = false;
    a.fb.homing_error = reason != Reason::interrupted;
    feedback_.publish(a, t);
    drive_.notice(Severity::warning, "homing", code, fmt::format("axis {}: the reference run has not come to its end: {}", a.channel, text),
                  t, a.id);
    jobs_.over(a, Outcome::failed, reason, std::move(text), t, code);
}

/// Steps: 1 the run, 2 its position, 3 its flag.
void Homing::run_home(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    if (!reply) {
        if (jobs_.ended_by_state(a, t)) return;
        const int method = std::get<Home>(j.command.body).method;
        j.step = 1;
        if (method == 0) return jobs_.ask(a, code::reference);
        if (method == 35 || method == 37) return jobs_.ask(a, code::reference_here, "0.0");
        return jobs_.refuse(
            a, Reason::not_supported,
            fmt::format("homing method {}: the control's own reference run (0) is set by its axis parameters; 35 and 37 reference "
                        "the axis where it stands",
                        method),
            t);
    }
    const std::string cause = drive_.what_ended(a);
    if (j.step == 1 && reply->quit != 0) {
        if (!j.begun) {
            jobs_.ended_by_quit(a, *reply, t, advice_for(reply->quit));
            return;
        }
        ++drive_.bus.counters.refused;
        const std::string refusal = fmt::format("{}: {}", describe(j.request), describe_quit(reply->quit));
        return aborted(a, cause.empty() ? refusal : cause + "; " + refusal, drive_.error != 0 ? drive_.error : reply->quit, t);
    }
    if (!cause.empty()) return aborted(a, cause, drive_.error, t);
    if (j.step == 1) {
        if (a.motion.kind != Motion::Kind::reference) feedback_.begin_motion(a, {Motion::Kind::reference}, t);
        if (j.request.code == code::reference && !j.begun) {
            if (!j.command.until_done) drive_.tickets.accepted(j.command.ticket, t.out);
            return watch(a, a, t);
        }
        j.step = 2;
        return jobs_.ask(a, code::position);
    }
    if (j.step >= first_of_watch) {
        const Run run = watched(a, a, *reply, t);
        if (run == Run::under_way) return;
        if (run == Run::failed) return aborted(a, "the axis stands and is not referenced (SM flag 0)", 0, t);
    } else if (j.step == 2) {
        if (reply->quit == 0) {
            a.counter = increments_of(number_of(*reply).value_or(0));
            a.counter_at = t.now;
            a.demand.fresh = true;
        }
        j.step = 3;
        if (!drive_.system_flags_missing) return jobs_.ask(a, request_for(code::system_flag, referenced_flag + a.number()));
    }
    // "Done" is believed when the flag says so where the control has it.
    const bool asked = j.request.code == code::system_flag;
    if (asked && reply->quit == 0 && number_of(*reply).value_or(0) == 0)
        return aborted(a, "end of processing was reported, but the axis is not referenced (SM flag 0)", 0, t);
    a.running = false;
    feedback_.end_motion(a, true, Reason::none, {}, t);
    jobs_.finished(a, t);
}

// --- a run that was acknowledged before its end ------------------------------------------------------------------------------------

/// The acknowledgement came with end of processing at once. Some controls say so when the run begins: the flag, the status and the
/// position of `x` show its end.
void Homing::watch(Axis& a, const Axis& x, Turn& t) {
    Job& j = a.job;
    j.step = first_of_watch;
    j.shown_at = t.now;
    j.limit = t.now + drive_.options.processing_limit;
    j.place = x.counter;
    j.flag = -1;
    jobs_.ask(a, request_for(code::position, x.number()));
}

Homing::Run Homing::watched(Axis& a, Axis& x, const Reply& reply, Turn& t) {
    Job& j = a.job;
    const bool told = reply.quit == 0;
    if (j.step == first_of_watch) {
        if (told) feedback_.learn_position(x, reply, t);
        if (std::llabs(x.counter - j.place) > noise_limit) {
            j.place = x.counter;
            j.shown_at = t.now;
        }
        if (!drive_.system_flags_missing) {
            ++j.step;
            jobs_.ask(a, request_for(code::system_flag, referenced_flag + x.number()));
            return Run::under_way;
        }
    } else if (j.step == first_of_watch + 1) {
        j.flag = told ? number_of(reply).value_or(0) != 0 : -1;
    } else {
        if (told) feedback_.learn_status(x, static_cast<int>(number_of(reply).value_or(-1)), t);
        const bool moves = told && x.status == 1;
        if (moves) j.shown_at = t.now;
        if (j.flag == 1 && !moves) return Run::ended;
        if (t.now >= j.shown_at + rest_limit || t.now >= j.limit) return j.flag == 0 || moves ? Run::failed : Run::ended;
        j.step = first_of_watch;
        jobs_.ask(a, request_for(code::position, x.number()));
        jobs_.ask_later(a, t.now + watch_period);
        return Run::under_way;
    }
    j.step = first_of_watch + 2;
    jobs_.ask(a, request_for(code::status_axis, x.number()));
    return Run::under_way;
}

// --- several axes ----------------------------------------------------------------------------------------------------------------

/// Steps: 1 a run, 2 its position; then the next axis.
void Homing::run_several(Axis& a, const Reply& reply, Turn& t) {
    Job& j = a.job;
    Axis& x = drive_.axes[j.places[j.at]];
    if (j.step == 1) {
        const std::string cause = drive_.what_ended(x);
        const bool good = reply.quit == 0 && cause.empty();
        const Reason reason = drive_.in_trouble() || cause.empty() ? Reason::drive_refused : Reason::interrupted;
        if (x.motion.kind != Motion::Kind::reference && good) feedback_.begin_motion(x, {Motion::Kind::reference}, t);
        if (good && !std::exchange(j.begun, false)) return watch(a, x, t);
        x.running = false;
        const std::string refusal = reply.quit == 0 ? std::string() : fmt::format("{}: {}", describe(j.request), describe_quit(reply.quit));
        feedback_.end_motion(x, good, reason, cause.empty() ? refusal : cause, t);
        if (!good) {
            drive_.bus.counters.refused += reply.quit != 0;
            return jobs_.over(
                a, reply.quit != 0 && !j.begun && j.at == 0 ? Outcome::refused : Outcome::failed, reason,
                fmt::format("axis {} did not come to its reference: {}{}{}; axes before it in the order are referenced, {} of {}",
                            x.channel, cause, cause.empty() || refusal.empty() ? "" : "; ", refusal, j.at, j.places.size()),
                t, drive_.error != 0 ? drive_.error : reply.quit);
        }
        j.step = 2;  // the position has a new zero: known before the end is published
        return jobs_.ask(a, request_for(code::position, x.number()));
    }
    if (j.step >= first_of_watch) {
        const std::string cause = drive_.what_ended(x);
        const Run run = cause.empty() ? watched(a, x, reply, t) : Run::failed;
        if (run == Run::under_way) return;
        x.running = false;
        const Reason reason = cause.empty() || drive_.in_trouble() ? Reason::drive_refused : Reason::interrupted;
        feedback_.end_motion(x, run == Run::ended, reason, cause, t);
        if (run == Run::failed)
            return jobs_.over(a, Outcome::failed, reason,
                              fmt::format("axis {} did not come to its reference: {}; axes before it in the order are referenced, {} of {}",
                                          x.channel, cause.empty() ? "it stands, and its SM flag is 0" : cause, j.at, j.places.size()),
                              t, drive_.error);
    } else if (reply.quit == 0) {
        feedback_.learn_position(x, reply, t);
    }
    if (++j.at >= j.places.size()) return jobs_.over(a, Outcome::done, Reason::none, fmt::format("{} axes referenced", j.places.size()), t);
    j.step = 1;
    jobs_.ask(a, request_for(code::reference, drive_.axes[j.places[j.at]].number()));
}

void Homing::start_several(Axis& a, std::string_view argument, Turn& t) {
    if (jobs_.ended_by_state(a, t)) return;
    constexpr std::uint32_t wrong = 1u << Control::channels;
    std::uint32_t mask = 0;
    const auto w = words_of(argument);
    if (w.empty()) {
        mask = 1u << a.place();
    } else if (w.size() == 1 && w[0] == "all") {
        for (const Axis& x : drive_.axes)
            mask |= x.here() ? 1u << x.place() : 0u;
    } else if (w.size() == 1 && w[0].starts_with("0x")) {
        mask = whole_of(w[0]).value_or(0);
    } else {
        for (const auto& one : w) {
            const auto n = whole_of(one);
            mask |= n && *n >= 1 && *n <= drive_.axes.size() ? 1u << (*n - 1) : wrong;
        }
    }
    for (const Axis& x : drive_.axes)
        if ((mask >> x.place() & 1u) && !x.used()) mask |= wrong;
    if (mask == 0 || mask >= wrong)
        return jobs_.refuse(a, Reason::out_of_range, "reference takes all, channels of the site's axes as in 1,3, or a mask as in 0x5", t);
    Job& j = a.job;
    const auto take = [&](std::size_t place) {
        if (mask >> place & 1u) j.places.push_back(place);
        mask &= ~(1u << place);
    };
    for (const int channel : drive_.options.reference_order)
        take(static_cast<std::size_t>(channel) - 1);
    for (std::size_t i = 0; i < drive_.axes.size(); ++i)
        take(i);
    j.verb = this;
    j.step = 1;
    jobs_.ask(a, request_for(code::reference, drive_.axes[j.places[0]].number()));
}

}  // namespace axisgate::pacontrol
