// Jobs: the exchanges of all axes' commands in turn, and the end of processing that bars the line.
// In: what the verbs ask. Out: exchanges, results. What has no answer and may not be repeated reads the position back, and has failed.
#include "adapters/pacontrol/drive_jobs.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "adapters/pacontrol/wire_number.hpp"

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr std::uint8_t frame_tries = 4;  // of one request that the control could not read (10h, 11h, 12h)
constexpr Duration processing_period = std::chrono::milliseconds(20);
constexpr Duration again_pause = std::chrono::milliseconds(20);
constexpr Duration mode_pause = std::chrono::seconds(2);  // until the status tells what became of a change of mode

bool moves_and_tells(std::uint16_t c) { return c == code::move_absolute_wait || c == code::move_relative_wait; }
}  // namespace

// --- for the verbs ---------------------------------------------------------------------------------------------------------------

void Jobs::ask(Axis& a, Request request) {
    a.job.request = std::move(request);
    a.job.want = Job::Want::send;
    a.job.tries = 0;
    a.job.not_before = {};
}

void Jobs::ask(Axis& a, std::uint16_t what, std::string data) {
    const CommandInfo* c = command_info(what);
    ask(a, request_for(what, c && c->parameter == Takes::nothing ? 0 : a.number(), std::move(data)));
}

void Jobs::ask_poll(Axis& a) {
    a.job.poll = true;
    a.job.want = Job::Want::send;
}

void Jobs::ask_later(Axis& a, Instant at) {
    a.job.want = Job::Want::send;
    a.job.tries = 0;
    a.job.not_before = at;
}

void Jobs::wait(Axis& a, Instant limit) {
    a.job.want = Job::Want::wait;
    a.job.limit = limit;
}

void Jobs::over(Axis& a, Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code, Value value,
                std::vector<std::uint8_t> bytes) {
    if (!a.job.active()) return;
    const Ticket ticket = std::exchange(a.job, Job{}).command.ticket;
    drive_.tickets.answer(ticket, outcome, reason, std::move(text), t.out, code, std::move(value), std::move(bytes));
}

void Jobs::finished(Axis& a, Turn& t) { over(a, a.job.command.until_done ? Outcome::done : Outcome::accepted, Reason::none, "", t); }

void Jobs::accepted(Axis& a, Wait::For what, std::int64_t value, std::string text, Turn& t) {
    const Command c = std::exchange(a.job, Job{}).command;
    drive_.feedback.accepted(a, c, what, value, std::move(text), t);
}

bool Jobs::ended_by_quit(Axis& a, const Reply& reply, Turn& t, std::string_view advice, Reason reason) {
    if (reply.quit == 0) return false;
    ++drive_.bus.counters.refused;
    if (a.job.request.code == code::abort_online) drive_.leaving = false;
    if (reply.quit == quit::not_switched_on && a.on) {
        a.on = false;  // the control says IDLE or SAFE [L4071]: switched off at the control
        drive_.feedback.publish(a, t);
    }
    std::string text = fmt::format("{}: {}", describe(a.job.request), describe_quit(reply.quit));
    if (reply.quit == quit::inadmissible) text += fmt::format(", which is {}", status_text(reply.status));
    if (reply.error != 0) text += fmt::format("; PA-CONTROL error E{}", reply.error);
    if (!advice.empty()) text += fmt::format(": {}", advice);
    over(a, Outcome::refused, reason, std::move(text), t, reply.quit);
    return true;
}

bool Jobs::ended_by_state(Axis& a, Turn& t) {
    std::string why = drive_.why_not_movable(a);
    if (why.empty()) return false;
    refuse(a, Reason::wrong_state, std::move(why), t);
    return true;
}

// --- exchanges -------------------------------------------------------------------------------------------------------------------

void Jobs::wake(Turn& t) {
    if (!std::exchange(drive_.wake, false)) return;
    for (Axis& a : drive_.axes) {
        if (!a.job.waits()) continue;
        a.job.want = Job::Want::nothing;
        run(a, nullptr, t);
    }
}

void Jobs::send_of(Axis& a, Turn& t) {
    Job& j = a.job;
    j.in_flight = true;
    j.want = Job::Want::nothing;
    ++j.tries;
    if (j.request.code == code::abort_online) drive_.leaving = true;  // whoever asks for it here, it is no surprise
    const Sent sent{Purpose::job, a.place(), j.request, j.poll, {}, j.command.ticket};
    j.raw.empty() ? drive_.port.send(sent, Priority::command, t) : drive_.port.send_raw(sent, j.raw, t);
}

bool Jobs::send(Turn& t) {
    for (std::size_t n = 0; n < drive_.axes.size(); ++n) {
        Axis& a = drive_.axes[std::exchange(next_, (next_ + 1) % drive_.axes.size())];
        if (a.job.want != Job::Want::send || a.job.in_flight || a.job.not_before > t.now) continue;
        send_of(a, t);
        return true;
    }
    return false;
}

/// A poll that a client asked for is the one thing of a client that may cross the line while a command is being processed.
bool Jobs::send_native_poll(Turn& t) {
    const auto a = std::ranges::find_if(drive_.axes, [](const Axis& x) { return x.job.poll && x.job.want == Job::Want::send; });
    if (a == drive_.axes.end()) return false;
    send_of(*a, t);
    return true;
}

void Jobs::answered(Axis& a, const Reply& reply, Turn& t) {
    Job& j = a.job;
    const bool orphan = !j.active() || !j.in_flight;  // a stop has ended it meanwhile
    j.in_flight = false;
    if (!orphan && j.poll && drive_.processing.active) {
        run(a, &reply, t);
        if (reply.end && !drive_.processing.hidden) processing_over(reply, t);
        return;
    }
    const bool on = reply.quit == 0 && !reply.end;
    if (!orphan && comes_again(a, reply, t.now)) return;
    if (orphan) {
        if (on) drive_.begin_processing(a.place(), 0, true, t.now);
        return;
    }
    if (on) {
        drive_.begin_processing(a.place(), j.request.code, false, t.now);
        if (j.kind == Job::Kind::single && !j.places.empty()) drive_.processing.axis = j.places[j.at];
    }
    if (j.unknown) {
        if (reply.quit == 0) drive_.feedback.learn_position(a, reply, t);
        return over(a, Outcome::failed, Reason::no_answer,
                    fmt::format("{}; the position read back is {}", j.text, reply.quit == 0 ? reply.data : "not known"), t);
    }
    on ? goes_on(a, reply, t) : run(a, &reply, t);
}

/// Refused only because the control is not ready for it yet: after a change of its mode (15h), before an axis is on (37h), while an axis
/// brakes (2Ah). The request is repeated for as long as that may last, which the manual does not say.
bool Jobs::comes_again(Axis& a, const Reply& reply, Instant now) {
    const Job& j = a.job;
    if (j.kind == Job::Kind::native || j.poll || !j.raw.empty()) return false;
    const CommandInfo* c = command_info(j.request.code);
    const std::size_t place = j.request.parameter - 1;
    const Axis& x = c && c->parameter == Takes::axis && place < drive_.axes.size() ? drive_.axes[place] : a;
    const Instant until = reply.quit == quit::not_executable    ? drive_.busy_until
                          : reply.quit == quit::not_switched_on ? x.switching_until
                          : reply.quit == quit::axis_moves      ? x.stopping_until
                                                                : Instant{};
    if (now >= until) return false;
    ask_later(a, now + again_pause);
    return true;
}

void Jobs::goes_on(Axis& a, const Reply& reply, Turn& t) {
    Job& j = a.job;
    j.processing = j.begun = true;
    if (reply.real && moves_and_tells(j.request.code)) drive_.feedback.learn_position(a, reply, t);
    if (j.kind == Job::Kind::home || (j.kind == Job::Kind::single && !j.places.empty())) {
        drive_.feedback.begin_motion(drive_.axes[drive_.processing.axis], {Motion::Kind::reference}, t);
        if (!j.command.until_done) drive_.tickets.accepted(j.command.ticket, t.out);  // nobody waits for the end: it has begun
    }
    if (j.kind == Job::Kind::native) run(a, &reply, t);  // the answer is the answer; the polls go on without it
}

void Jobs::not_read(Axis& a, const Reply& reply, Turn& t) {
    Job& j = a.job;
    if (!j.active() || !j.in_flight) return;
    j.in_flight = false;
    if (j.tries < frame_tries && j.raw.empty()) {
        j.want = Job::Want::send;
    } else if (j.kind == Job::Kind::native) {
        run(a, &reply, t);
    } else {
        ended_by_quit(a, reply, t, "the line is disturbed, or check is set wrongly (option check)");
    }
}

/// No answer to the present request.
void Jobs::silent(Axis& a, Turn& t) {
    Job& j = a.job;
    if (!j.active() || !j.in_flight) return;
    j.in_flight = false;
    const CommandInfo* c = command_info(j.request.code);
    const bool repeatable = c && c->repeatable && j.kind != Job::Kind::native;
    if (repeatable && j.tries <= drive_.bus.timing.retries) {
        ++drive_.bus.counters.retries;
        j.want = Job::Want::send;
        return;
    }
    const bool changes_mode = j.kind == Job::Kind::enable || j.kind == Job::Kind::reset || j.kind == Job::Kind::mode;
    if (changes_mode && ++j.rounds <= drive_.bus.timing.retries) return wait(a, t.now + mode_pause);
    if (j.unknown) return over(a, Outcome::failed, Reason::no_answer, j.text + "; the position could not be read back", t);
    std::string text = fmt::format("{} was not acknowledged{}", j.poll ? "the poll" : describe(j.request),
                                   repeatable ? "" : ": whether the control carries it out is not known");
    if (!repeatable && c && c->online_only && c->parameter == Takes::axis && j.kind != Job::Kind::native) {
        j.unknown = true;
        j.text = std::move(text);
        a.reached = false;
        return ask(a, code::position);
    }
    over(a, Outcome::failed, Reason::no_answer, std::move(text), t);
}

// --- what is being processed -----------------------------------------------------------------------------------------------------

void Jobs::send_processing_poll(Turn& t) {
    Processing& p = drive_.processing;
    if (p.next_poll > t.now) return;
    p.next_poll = t.now + processing_period;
    drive_.port.send(
        {Purpose::processing, p.axis, request_for(code::status_axis, static_cast<std::uint32_t>(p.axis) + 1), !p.hidden && !p.by_status},
        Priority::command, t);
}

void Jobs::processing_answered(const Sent& sent, const Reply& reply, Turn& t) {
    if (!drive_.processing.active) return;
    Axis& a = drive_.axes[sent.axis];
    if (!sent.eot) {  // the status of the axis
        drive_.processing.by_status = false;
        if (reply.quit != 0 || !reply.end) return;  // still barred, or a late answer to a poll
        drive_.feedback.learn_status(a, static_cast<int>(number_of(reply).value_or(-1)), t);
        if (a.status != 1) processing_over(reply, t);
        return;
    }
    if (reply.real && number_of(reply) && moves_and_tells(drive_.processing.code)) drive_.feedback.learn_position(a, reply, t);
    if (!reply.end) a.running_at = t.now;
    drive_.feedback.publish_all(t);
    if (reply.end) processing_over(reply, t);
}

/// BE = 1 for what was being processed.
void Jobs::processing_over(const Reply& reply, Turn& t) {
    const Processing was = std::exchange(drive_.processing, Processing{});
    drive_.polls.hurry(t.now);
    Axis& a = drive_.axes[was.owner];
    if (!a.job.active() || !a.job.processing || was.foreign) return;  // the next cycle sees what became of it
    a.job.processing = false;
    run(a, &reply, t);
}

void Jobs::processing_late(Turn& t) {
    const Processing was = std::exchange(drive_.processing, Processing{});
    drive_.port.lose_step();
    Axis& a = drive_.axes[was.axis];
    Axis& owner = drive_.axes[was.owner];
    const std::string text = fmt::format("{:04X}: end of processing was not reported within {} s: what became of it is not known", was.code,
                                         milliseconds_of(drive_.options.processing_limit) / 1000);
    drive_.notice(Severity::warning, "protocol", 0, text, t, a.id);
    if (a.motion.active()) drive_.feedback.end_motion(a, false, Reason::no_answer, text, t);
    if (owner.job.processing) over(owner, Outcome::failed, Reason::no_answer, text, t);
}

// --- time ------------------------------------------------------------------------------------------------------------------------

void Jobs::late(Axis& a, Turn& t) {
    over(a, a.job.of_parameter() ? Outcome::refused : Outcome::failed, Reason::wrong_state,
         fmt::format("{}the control did not get there in time; {}", a.job.text.empty() ? "" : a.job.text + ": ", drive_.mode_text()), t);
}

void Jobs::on_deadline(Turn& t) {
    for (Axis& a : drive_.axes) {
        if (a.job.waits() && a.job.limit <= t.now) late(a, t);
    }
    if (drive_.processing.active && drive_.processing.limit <= t.now) processing_late(t);
}

Instant Jobs::deadline(Instant now) const noexcept {
    Instant d = drive_.processing.active ? drive_.processing.limit : never;
    for (const Axis& a : drive_.axes) {
        if (a.job.waits()) d = std::min(d, a.job.limit);
        if (a.job.active() && a.job.want == Job::Want::send && a.job.not_before > now) d = std::min(d, a.job.not_before);
    }
    return d;
}

}  // namespace axisgate::pacontrol
