// Drive: whose turn it is on the line, and which part an acknowledgement belongs to.
// In: commands, what became of each exchange, deadlines. Out: the next exchange.
// Order: stops; polls for an end of processing; what brings the line back into step; renewals of manual moves; commands; polls. After four
// commands in a row one poll gets its turn, so that a busy line still shows where the axes are.
#include "adapters/pacontrol/drive.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate::pacontrol {
namespace {
constexpr std::uint8_t commands_per_poll = 4;
constexpr Duration busy_limit = std::chrono::seconds(1);  // of commands that are refused after a change of the operating mode

bool changes_mode(const Sent& sent) {
    const std::uint16_t c = sent.request.code;
    return !sent.eot &&
           (c == code::stop || c == code::start_auto || c == code::start_online || c == code::abort_auto || c == code::abort_online);
}
}  // namespace

void Drive::set_axes(const DriveSetup& setup, Turn& t) {
    setup_ = setup;
    for (Axis& a : axes) {
        const auto it = std::ranges::find(setup.axes, a.channel, &AxisSetup::channel);
        const AxisId id = it == setup.axes.end() ? no_axis : it->id;
        if (id == a.id) continue;
        const bool moves = a.moves();
        const int channel = a.channel;
        fail_axis(a, Reason::line_down, "the axis was removed or changed", t);
        a = Axis{};
        a.channel = channel;
        a.id = id;
        polls.start_over();
        if (moves && ready()) stops.add(Stops::Kind::quick, a);  // nobody could stop it any more
    }
    polls.clear();
}

void Drive::look(const DriveSetup& setup) noexcept {
    for (Axis& a : axes) {
        const auto it = std::ranges::find(setup.axes, a.channel, &AxisSetup::channel);
        a.looked_at = it != setup.axes.end() && it->look_period > Duration::zero();
    }
    polls.look(setup);
}

void Drive::submit(const Command& c, Turn& t) {
    Axis& a = *axis_of(c.axis);  // one of its own: the roster looks
    if (drive::refused_behind(stops.locking(a), c, a.queue, t)) return;
    if (drive::admit(c, name(), presence, a.queue, tickets, t) == drive::Admission::urgent) stops.submit(a, c, t);
}

// --- turns -----------------------------------------------------------------------------------------------------------------------

void Drive::pump(Turn& t) {
    if (presence.is(Phase::down)) return;
    if (ready()) {
        jobs.wake(t);
        for (Axis& a : axes)
            take_next(a, t);
    }
    if (!port.free(t.now)) return;
    if (stops.ready()) return stops.send(t);
    if (!ready()) {
        if (!presence.probe_due(t.now)) return;
        presence.probe_sent();
        return port.send({Purpose::probe, 0, request_for(code::get_state)}, Priority::poll, t);
    }
    if (processing.active) {
        if (!jobs.send_native_poll(t)) jobs.send_processing_poll(t);
        return;
    }
    if (port.send_barrier(t) || send_renewal(t)) return;
    const bool poll = polls.wanted(t.now);
    if (!(poll && commands_in_a_row_ >= commands_per_poll) && jobs.send(t)) {
        ++commands_in_a_row_;
        return;
    }
    power.consider_give_back(t);
    if (port.busy() || !poll) return;
    commands_in_a_row_ = 0;
    port.send(polls.next(t.now), Priority::poll, t);
}

Instant Drive::deadline(Instant now) const noexcept {
    if (presence.is(Phase::down)) return never;
    Instant d = std::min(stops.deadline(), jobs.deadline(now));
    if (!port.free(now)) return std::min(d, port.deadline());
    if (!ready()) return std::min(d, presence.deadline());
    if (processing.active) return std::min(d, processing.next_poll);
    for (const Axis& a : axes)
        d = std::min(d, a.renewal.deadline());
    return std::min(d, polls.deadline());
}

void Drive::on_deadline(Turn& t) {
    if (presence.is(Phase::down)) return;
    port.on_deadline(t);
    stops.on_deadline(t);
    jobs.on_deadline(t);
}

bool Drive::send_renewal(Turn& t) {
    const auto a = std::ranges::find_if(axes, [&](const Axis& x) { return x.renewal.due(t.now); });
    if (a == axes.end()) return false;
    a->renewal.soon(t.now + renew_period);
    port.send({Purpose::renew, a->place(), request_for(code::manual_renew, a->number())}, Priority::command, t);
    return true;
}

// --- commands --------------------------------------------------------------------------------------------------------------------

std::pair<Job::Kind, Verb*> Drive::verb_for(const CommandBody& body) noexcept {
    using Kind = Job::Kind;
    if (std::holds_alternative<Enable>(body)) return {Kind::enable, &power};
    if (std::holds_alternative<ResetFault>(body)) return {Kind::reset, &power};
    if (std::holds_alternative<Home>(body)) return {Kind::home, &homing};
    if (std::holds_alternative<SetPosition>(body)) return {Kind::origin, &motion};
    if (std::holds_alternative<Move>(body)) return {Kind::move, &motion};
    if (std::holds_alternative<StartTogether>(body)) return {Kind::together, &motion};
    if (std::holds_alternative<ReadParameter>(body)) return {Kind::read, &parameters};
    if (std::holds_alternative<WriteParameter>(body)) return {Kind::write, &parameters};
    if (std::holds_alternative<Native>(body)) return {Kind::native, &native};
    if (std::holds_alternative<Action>(body)) return {Kind::single, &actions};
    return {Kind::single, nullptr};
}

/// Commands that end without an exchange let the next one follow at once; the queue's bound is the loop's.
void Drive::take_next(Axis& a, Turn& t) {
    while (!a.job.active() && !a.queue.empty()) {
        a.job = Job{};
        a.job.command = a.queue.pop();
        std::tie(a.job.kind, a.job.verb) = verb_for(a.job.command.body);
        if (a.missing) {
            jobs.refuse(a, Reason::wrong_state,
                        fmt::format("the control says that it has no axis {} (20h): system parameter 2 is the number of axes", a.channel),
                        t);
        } else if (!a.job.verb) {
            jobs.refuse(a, Reason::not_supported, "this is not a command of a PA-CONTROL", t);
        } else {
            jobs.run(a, nullptr, t);
        }
    }
}

// --- what became of an exchange --------------------------------------------------------------------------------------------------

void Drive::answered(const Sent& sent, const Reply& reply, Turn& t) {
    if (!ready()) found(t);
    feedback.learn(reply, t);
    demands.follow(sent, reply, t.now);
    if (reply.quit == 0 && changes_mode(sent)) busy_until = t.now + busy_limit;
    switch (sent.purpose) {
        case Purpose::probe:
        case Purpose::barrier:
            return;
        case Purpose::look:
            return look_answered(reply, t);
        case Purpose::job:
            return jobs.answered(axes[sent.axis], reply, t);
        case Purpose::processing:
            return jobs.processing_answered(sent, reply, t);
        case Purpose::stop:
            return stops.answered(sent, reply, t);
        case Purpose::renew:
            return renewed(axes[sent.axis], reply, t);
        case Purpose::give_back:
            if (reply.quit == 0) return;
            leaving = false;
            return notice(Severity::warning, "mode", reply.quit,
                          fmt::format("the control could not be given back: {}", describe_quit(reply.quit)), t);
        case Purpose::poll:
            return feedback.poll_answered(sent.poll, reply, t);
    }
}

/// What a command that was given up has left behind, if anything.
void Drive::look_answered(const Reply& reply, Turn& t) {
    if (!reply.end && !processing.active) begin_processing(0, 0, true, t.now);
}

void Drive::renewed(Axis& a, const Reply& reply, Turn& t) {
    if (reply.quit == 0) return feedback.learn_position(a, reply, t);
    feedback.end_motion(a, false, Reason::drive_refused, fmt::format("the manual move was not renewed: {}", describe_quit(reply.quit)), t);
}

void Drive::not_read(const Sent& sent, const Reply& reply, Turn& t) {
    if (!ready()) found(t);
    feedback.learn(reply, t);
    if (sent.purpose == Purpose::job) jobs.not_read(axes[sent.axis], reply, t);
    if (sent.purpose == Purpose::stop) stops.not_read(reply, t);  // everything else comes again by itself
}

void Drive::silent(const Sent& sent, Turn& t) {
    if (!sent.eot && (sent.purpose == Purpose::job || sent.purpose == Purpose::stop)) demands.not_acknowledged(sent.request);
    if (sent.purpose == Purpose::renew) axes[sent.axis].renewal.soon(t.now);
    if (sent.purpose == Purpose::processing) {
        processing.next_poll = t.now;
        processing.by_status = sent.eot;  // a control need not answer a poll once the end is told, nor a command before it
    }
    if (sent.purpose == Purpose::job) jobs.silent(axes[sent.axis], t);
    if (sent.purpose == Purpose::stop) stops.silent(t);
    if (!sent.eot) count_silence(t);  // a control need not answer a poll while nothing is processed
}

void Drive::in_step() {
    wake = true;
    stops.in_step();
}

}  // namespace axisgate::pacontrol
