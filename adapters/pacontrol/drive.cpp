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
}

Drive::Drive(LineForm& line, const DriveSetup& setup)
    : pac_(line, setup),
      port_(pac_, *this),
      polls_(pac_),
      demands_(pac_, port_, polls_),
      feedback_(pac_, polls_, demands_),
      jobs_(pac_, port_, feedback_),
      stops_(pac_, port_, feedback_, jobs_),
      power_(pac_, jobs_, feedback_, port_, stops_),
      motion_(pac_, jobs_, feedback_, stops_),
      homing_(pac_, jobs_, feedback_),
      parameters_(pac_, jobs_, feedback_),
      native_(pac_, jobs_, feedback_, port_),
      actions_(pac_, jobs_, feedback_, polls_, power_, homing_) {}

void Drive::set_axes(const DriveSetup& setup, Turn& t) {
    pac_.setup = setup;
    for (Axis& a : pac_.axes) {
        const auto it = std::ranges::find(setup.axes, a.channel, &AxisSetup::channel);
        const AxisId id = it == setup.axes.end() ? no_axis : it->id;
        if (id == a.id) continue;
        const bool moves = a.moves();
        const int channel = a.channel;
        fail_axis(a, Reason::line_down, "the axis was removed or changed", t);
        a = Axis{};
        a.channel = channel;
        a.id = id;
        polls_.start_over();
        if (moves && pac_.ready()) stops_.add(Stops::Kind::quick, a);  // nobody could stop it any more
    }
    polls_.clear();
}

void Drive::look(const DriveSetup& setup) noexcept {
    for (Axis& a : pac_.axes) {
        const auto it = std::ranges::find(setup.axes, a.channel, &AxisSetup::channel);
        a.looked_at = it != setup.axes.end() && it->look_period > Duration::zero();
    }
    polls_.look(setup);
}

void Drive::submit(const Command& c, Turn& t) {
    Axis& a = *pac_.axis_of(c.axis);  // one of its own: the roster looks
    if (drive::admit(c, pac_.setup.name, pac_.presence, a.queue, pac_.tickets, t) == drive::Admission::urgent) stops_.submit(a, c, t);
}

// --- turns -----------------------------------------------------------------------------------------------------------------------

void Drive::pump(Turn& t) {
    if (pac_.presence.is(Phase::down)) return;
    if (pac_.ready()) {
        jobs_.wake(t);
        for (Axis& a : pac_.axes)
            take_next(a, t);
    }
    if (!port_.free(t.now)) return;
    if (stops_.ready()) return stops_.send(t);
    if (!pac_.ready()) {
        if (!pac_.presence.probe_due(t.now)) return;
        pac_.presence.probe_sent();
        return port_.send({Purpose::probe, 0, request_for(code::get_state)}, Priority::poll, t);
    }
    if (pac_.processing.active) {
        if (!jobs_.send_native_poll(t)) jobs_.send_processing_poll(t);
        return;
    }
    if (port_.send_barrier(t) || send_renewal(t)) return;
    const bool poll = polls_.wanted(t.now);
    if (!(poll && commands_in_a_row_ >= commands_per_poll) && jobs_.send(t)) {
        ++commands_in_a_row_;
        return;
    }
    power_.consider_give_back(t);
    if (port_.busy() || !poll) return;
    commands_in_a_row_ = 0;
    port_.send(polls_.next(t.now), Priority::poll, t);
}

Instant Drive::deadline(Instant now) const noexcept {
    if (pac_.presence.is(Phase::down)) return never;
    Instant d = std::min(stops_.deadline(), jobs_.deadline());
    if (!port_.free(now)) return std::min(d, port_.deadline());
    if (!pac_.ready()) return std::min(d, pac_.presence.deadline());
    if (pac_.processing.active) return std::min(d, pac_.processing.next_poll);
    for (const Axis& a : pac_.axes)
        d = std::min(d, a.renewal.deadline());
    return std::min(d, polls_.deadline());
}

void Drive::on_deadline(Turn& t) {
    if (pac_.presence.is(Phase::down)) return;
    port_.on_deadline(t);
    stops_.on_deadline(t);
    jobs_.on_deadline(t);
}

bool Drive::send_renewal(Turn& t) {
    const auto a = std::ranges::find_if(pac_.axes, [&](const Axis& x) { return x.renewal.due(t.now); });
    if (a == pac_.axes.end()) return false;
    a->renewal.soon(t.now + renew_period);
    port_.send({Purpose::renew, a->place(), request_for(code::manual_renew, a->number())}, Priority::command, t);
    return true;
}

// --- commands --------------------------------------------------------------------------------------------------------------------

std::pair<Job::Kind, Verb*> Drive::verb_for(const CommandBody& body) noexcept {
    using Kind = Job::Kind;
    if (std::holds_alternative<Enable>(body)) return {Kind::enable, &power_};
    if (std::holds_alternative<ResetFault>(body)) return {Kind::reset, &power_};
    if (std::holds_alternative<Home>(body)) return {Kind::home, &homing_};
    if (std::holds_alternative<SetPosition>(body)) return {Kind::origin, &motion_};
    if (std::holds_alternative<Move>(body)) return {Kind::move, &motion_};
    if (std::holds_alternative<StartTogether>(body)) return {Kind::together, &motion_};
    if (std::holds_alternative<ReadParameter>(body)) return {Kind::read, &parameters_};
    if (std::holds_alternative<WriteParameter>(body)) return {Kind::write, &parameters_};
    if (std::holds_alternative<Native>(body)) return {Kind::native, &native_};
    if (std::holds_alternative<Action>(body)) return {Kind::single, &actions_};
    return {Kind::single, nullptr};
}

/// Commands that end without an exchange let the next one follow at once; the queue's bound is the loop's.
void Drive::take_next(Axis& a, Turn& t) {
    while (!a.job.active() && !a.queue.empty()) {
        a.job = Job{};
        a.job.command = a.queue.pop();
        std::tie(a.job.kind, a.job.verb) = verb_for(a.job.command.body);
        if (a.missing) {
            jobs_.refuse(a, Reason::wrong_state,
                         fmt::format("the control says that it has no axis {} (20h): system parameter 2 is the number of axes", a.channel),
                         t);
        } else if (!a.job.verb) {
            jobs_.refuse(a, Reason::not_supported, "this is not a command of a PA-CONTROL", t);
        } else {
            jobs_.run(a, nullptr, t);
        }
    }
}

// --- what became of an exchange --------------------------------------------------------------------------------------------------

void Drive::answered(const Sent& sent, const Reply& reply, Turn& t) {
    if (!pac_.ready()) found(t);
    feedback_.learn(reply, t);
    demands_.follow(sent, reply, t.now);
    switch (sent.purpose) {
        case Purpose::probe:
        case Purpose::barrier:
            return;
        case Purpose::look:
            return look_answered(reply, t);
        case Purpose::job:
            return jobs_.answered(pac_.axes[sent.axis], reply, t);
        case Purpose::processing:
            return jobs_.processing_answered(sent, reply, t);
        case Purpose::stop:
            return stops_.answered(sent, reply, t);
        case Purpose::renew:
            return renewed(pac_.axes[sent.axis], reply, t);
        case Purpose::give_back:
            if (reply.quit == 0) return;
            pac_.leaving = false;
            return pac_.notice(Severity::warning, "mode", reply.quit,
                               fmt::format("the control could not be given back: {}", describe_quit(reply.quit)), t);
        case Purpose::poll:
            return feedback_.poll_answered(sent.poll, reply, t);
    }
}

/// What a command that was given up has left behind, if anything.
void Drive::look_answered(const Reply& reply, Turn& t) {
    if (!reply.end && !pac_.processing.active) pac_.begin_processing(0, 0, true, t.now);
}

void Drive::renewed(Axis& a, const Reply& reply, Turn& t) {
    if (reply.quit == 0) return feedback_.learn_position(a, reply, t);
    feedback_.end_motion(a, false, Reason::drive_refused, fmt::format("the manual move was not renewed: {}", describe_quit(reply.quit)), t);
}

void Drive::not_read(const Sent& sent, const Reply& reply, Turn& t) {
    if (!pac_.ready()) found(t);
    feedback_.learn(reply, t);
    if (sent.purpose == Purpose::job) jobs_.not_read(pac_.axes[sent.axis], reply, t);
    if (sent.purpose == Purpose::stop) stops_.not_read(reply, t);  // everything else comes again by itself
}

void Drive::silent(const Sent& sent, Turn& t) {
    if (!sent.eot && (sent.purpose == Purpose::job || sent.purpose == Purpose::stop)) demands_.not_acknowledged(sent.request);
    if (sent.purpose == Purpose::renew) pac_.axes[sent.axis].renewal.soon(t.now);
    if (sent.purpose == Purpose::processing) pac_.processing.next_poll = t.now;
    if (sent.purpose == Purpose::job) jobs_.silent(pac_.axes[sent.axis], t);
    if (sent.purpose == Purpose::stop) stops_.silent(t);
    count_silence(t);
}

void Drive::unasked(const Reply& reply, Turn& t) {
    if (pac_.ready()) feedback_.learn(reply, t);
}

void Drive::in_step() {
    pac_.wake = true;
    stops_.in_step();
}

}  // namespace axisgate::pacontrol
