// Dialogue, second half: the choice of the next request, and the treatment of answers and of time-outs. Only dialogue.hpp includes this
// file. Requests that a client has written itself and set-points are never repeated.
#pragma once

#include <fmt/core.h>

#include "gateway/drive/dialogue.hpp"

namespace axisgate::drive {

// --- commands and set-points -----------------------------------------------------------------------------------------------------

template <class Message, int Channels>
void Dialogue<Message, Channels>::set_axes(const DriveSetup& setup, Turn& t) {
    const auto in = [](const DriveSetup& s, const AxisSetup& a) {
        return std::ranges::any_of(s.axes, [&](const AxisSetup& x) { return x.id == a.id && x.channel == a.channel; });
    };
    for (const AxisSetup& a : setup_.axes) {
        if (in(setup, a) || !has(a.channel)) continue;
        const auto its = [&](const Command& w) { return w.axis == a.id; };
        tickets.fail_axis(a.id, Reason::line_down, "the axis was removed or changed", t.out);
        (void)queue_.interrupt(its, "its removal", tickets, t);
        set_points_.forget(a.id);
        if (job_ && its(job_->command)) job_.reset();
        polls_.drop(item(a.channel));
        at(a.channel).enabling.clear();
        if (std::exchange(at(a.channel).feedback, {}).moving)  // after its removal no client could stop the axis
            (void)stops_.add({Ask::Why::stop, this->stop({no_ticket, a.id, QuickStop{}, false, {}}), no_ticket, a.channel, 0});
    }
    for (const AxisSetup& a : setup.axes)
        if (presence.online() && !in(setup_, a)) poll_every(a.channel, t);
    setup_ = setup;
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::submit(const Command& c, Turn& t) {
    if (is_urgent(c.body) || is_motion(c.body)) set_points_.forget(c.axis);
    const CommandBody* stop = nullptr;
    stops_.each([&](const Ask& s) {
        if (s.channel == channel_of(c.axis) && s.body && !std::holds_alternative<Halt>(*s.body)) stop = &*s.body;
    });
    if (refused_behind(stop, c, queue_, t) || admit(c, name(), presence, queue_, tickets, t) != Admission::urgent) return;
    const auto ends = [&](const Command& w) { return w.axis == c.axis && ended_by(c.body, w.body); };
    (void)queue_.interrupt(ends, name_of(c.body), tickets, t);
    if (job_ && ends(job_->command)) {
        tickets.failed(job_->command.ticket, Reason::interrupted, CommandQueue::interrupted_by(name_of(c.body)), t.out);
        job_.reset();
    }
    const int channel = channel_of(c.axis);
    at(channel).followed = {};
    if (ended_by(c.body, Enable{})) {
        for (const Ticket ticket : std::exchange(at(channel).enabling, {}))
            tickets.failed(ticket, Reason::interrupted, CommandQueue::interrupted_by(name_of(c.body)), t.out);
    }
    exchange_.no_repeats();
    if (!stops_.add({Ask::Why::stop, this->stop(c), c.ticket, channel, 0, c.body}))
        tickets.refused(c.ticket, Reason::busy, fmt::format("{} stops are on their way already", stop_limit), t.out);
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::begin(Job job, Turn& t) {
    Reason reason = Reason::not_supported;
    std::string why = this->plan(job, reason);
    if (why.empty() && job.steps.empty()) why = "there is nothing to be sent for it";
    if (why.empty()) {
        job.number = ++jobs_;
        job_ = std::move(job);
    } else if (job.streamed) {
        at(channel_of(job.command.axis)).followed = {};
        t.out.stream_ends.push_back({job.command.axis, reason, std::move(why)});
    } else {
        tickets.refused(job.command.ticket, reason, std::move(why), t.out);
    }
}

/// A motion without a ticket. The drive keeps speed and ramps as settings, so they are sent again only when they change.
template <class Message, int Channels>
typename Dialogue<Message, Channels>::Job Dialogue<Message, Channels>::job_for(const SetPoint& p) {
    Job job;
    job.streamed = true;
    job.command.axis = p.axis;
    Move wanted = p.as_move();
    Move& before = at(channel_of(p.axis)).followed;
    const auto only_new = [](std::optional<std::int64_t>& value, std::optional<std::int64_t>& kept) {
        if (value && value != std::exchange(kept, value)) return;
        value.reset();
    };
    only_new(wanted.acceleration, before.acceleration);
    only_new(wanted.deceleration, before.deceleration);
    only_new(wanted.velocity, before.velocity);
    job.command.body = wanted;
    return job;
}

// --- transmission ----------------------------------------------------------------------------------------------------------------

template <class Message, int Channels>
Want Dialogue<Message, Channels>::wants(Instant now) const noexcept {
    if (exchange_.active() || presence.is(Presence::Phase::down)) return Want::nothing;
    if (!stops_.empty()) return Want::urgent;
    if (!presence.online()) return presence.probe_due(now) ? Want::probe : Want::nothing;
    if (job_ || !queue_.empty() || !set_points_.empty()) return Want::command;
    const bool moves = std::ranges::any_of(axes_, [](const Axis& a) { return a.feedback.moving; });
    return !polls_.due(now) ? Want::nothing : moves && !pace_.close() ? Want::quick_poll : Want::poll;
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::go(Turn& t) {
    if (!stops_.empty()) return send(*stops_.first(), bus_.timing.retries, t);
    if (!presence.online()) {
        presence.probe_sent();
        return send({Ask::Why::probe, this->probe(false), no_ticket, 0, 0}, 0, t);
    }
    while (!job_ && !queue_.empty()) {
        Job next;
        next.command = queue_.pop();
        at(channel_of(next.command.axis)).followed = {};  // the command may change settings that the stream has sent
        begin(std::move(next), t);
    }
    const bool poll_first = streamed_last_ && polls_.due(t.now);  // the position must be read regularly, even while set-points arrive
                                                                  // without a pause
    streamed_last_ = !job_ && !set_points_.empty() && !poll_first;
    if (streamed_last_) begin(job_for(set_points_.take()), t);
    if (job_) {
        const bool once = job_->streamed || std::holds_alternative<Native>(job_->command.body);
        return send({Ask::Why::step, job_->steps[job_->at], job_->command.ticket, channel_of(job_->command.axis), job_->number},
                    once ? 0 : bus_.timing.retries, t);
    }
    if (const auto channel = polls_.next(t.now)) send({Ask::Why::poll, this->poll(static_cast<int>(*channel)), no_ticket, 0, 0}, 0, t);
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::send(Ask ask, int retries, Turn& t) {
    // A late answer to an earlier request of the same kind could be taken for the answer to this one. Therefore another request is sent
    // first: the drive answers in order, so the answers after that one are new. A stop does not wait for this.
    if (ask.why != Ask::Why::stop && late_.has(this->mark_of(ask.message))) {
        ask = {Ask::Why::poll, this->probe(late_.has(this->mark_of(this->probe(false)))), no_ticket, 0, 0};
        if (late_.has(this->mark_of(ask.message))) late_.clear();
        retries = 0;
    }
    const Duration patience = bus_.timing.reply_timeout + bus_.on_wire;
    bus_.turns.began(slot(), ask.why == Ask::Why::probe);
    exchange_.begin(std::move(ask), t.now, patience, retries);
    transmit(t);
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::transmit(Turn& t) const {
    const auto why = exchange_.request().why;
    const Priority priority = why == Ask::Why::stop ? Priority::urgent : why == Ask::Why::step ? Priority::command : Priority::poll;
    t.out.send(this->frame_of(exchange_.request().message), priority, exchange_.request().ticket);
}

// --- reception -------------------------------------------------------------------------------------------------------------------

template <class Message, int Channels>
void Dialogue<Message, Channels>::on_message(const Message& answer, Turn& t) {
    const Message& asked = exchange_.request().message;
    if (!exchange_.active() || this->mark_of(asked) != this->mark_of(answer) ||
        !(this->reported(answer).refused || this->answers(asked, answer))) {
        ++bus_.counters.unexpected;
        return presence.received(t.now);
    }
    const bool again = exchange_.tries() > 1;  // the answers to the other copies may still arrive
    const Ask ask = exchange_.answered(bus_.counters);
    const Message mark = this->mark_of(ask.message);
    if (again) late_.add(mark);
    bus_.turns.ended(slot());
    bus_.turns.received(t.now);
    presence.answered();
    if (!late_.has(mark)) late_.clear();
    answered(ask, answer, t);
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::answered(const Ask& ask, const Message& answer, Turn& t) {
    const Reported what = this->reported(answer);
    if (what.refused) ++bus_.counters.refused;
    if (!presence.online()) {
        presence.found();
        presence.made_ready();
        presence.report(this->title(ask.why == Ask::Why::probe ? &answer : nullptr), t.out);
        for (const AxisSetup& a : setup_.axes)
            poll_every(a.channel, t);
    }
    if (!what.refused) learnt(this->learn(answer), t);
    if (ask.why == Ask::Why::step && job_ && job_->number == ask.job) return step_answered(answer, t);
    if (ask.why != Ask::Why::stop) return;
    if (!stops_.empty()) stops_.remove(stops_.first());
    (void)polls_.soon(item(ask.channel), t.now);
    if (!what.refused) at(ask.channel).rest_until = {};
    if (!what.refused && ask.body && std::holds_alternative<Disable>(*ask.body)) at(ask.channel).off_until = t.now + state_is_late;
    if (!what.refused) tickets.accepted(ask.ticket, t.out);
    tickets.refused(ask.ticket, Reason::drive_refused, "the drive refuses the stop with code " + what.text, t.out);
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::step_answered(const Message& answer, Turn& t) {
    const Reported what = this->reported(answer);
    const CommandBody& body = job_->command.body;
    if (what.refused && !std::holds_alternative<Native>(body)) {
        const ErrorCode* known = bus_.catalogue.error(what.code);
        std::string why = fmt::format("{}: {}", this->words_of(job_->steps[job_->at]), known ? known->text : "code " + what.text);
        if (job_->streamed) {
            at(channel_of(job_->command.axis)).followed = {};
            t.out.stream_ends.push_back({job_->command.axis, Reason::drive_refused, why});
        }
        tickets.refused(job_->command.ticket, Reason::drive_refused, std::move(why), t.out, what.code);
        return job_.reset();
    }
    this->stepped(*job_, answer);
    if (++job_->at < job_->steps.size()) return;
    const Job job = *std::exchange(job_, std::nullopt);
    finish(job, what, t);
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::finish(const Job& job, const Reported& what, Turn& t) {
    const CommandBody& body = job.command.body;
    const int channel = channel_of(job.command.axis);
    AxisFeedback& fb = at(channel).feedback;
    if (!job.streamed || !fb.moving) (void)polls_.soon(item(channel), t.now);
    if (job.streamed) return;
    if (const auto* move = std::get_if<Move>(&body)) {
        at(channel).target = move->kind == Move::Kind::relative ? fb.position + move->target : move->target;
        at(channel).rest_until = move->kind == Move::Kind::velocity ? Instant{} : t.now + state_is_late;
        fb.target_reached = false;  // "target reached" of the old target must not be reported for the new one
        fb.moving = true;
        emit(channel, t);
    } else if (std::holds_alternative<Home>(body) || std::holds_alternative<SetPosition>(body)) {
        at(channel).rest_until = {};
    }
    this->acted(body, fb);
    if (std::holds_alternative<Enable>(body) && fb.power != AxisFeedback::Power::on) {
        at(channel).enabling.push_back(job.command.ticket);
        at(channel).on_by = t.now + power_shows_within;
        return;
    }
    if (const Parameter* p = parameter_of(body)) {
        tickets.answer(job.command.ticket, Outcome::done, Reason::none, {}, t.out, 0, parse_value(what.text, p->type).value_or(Value{}));
    } else if (std::holds_alternative<Native>(body)) {
        tickets.answer(job.command.ticket, Outcome::accepted, Reason::none, what.text, t.out, 0, {}, {what.text.begin(), what.text.end()});
    } else {
        tickets.accepted(job.command.ticket, t.out);
    }
}

template <class Message, int Channels>
const Parameter* Dialogue<Message, Channels>::parameter_of(const CommandBody& body) const {
    const auto* read = std::get_if<ReadParameter>(&body);
    const auto* write = std::get_if<WriteParameter>(&body);
    return read ? bus_.catalogue.parameter(read->point) : write ? bus_.catalogue.parameter(write->point) : nullptr;
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::learnt(int channel, Turn& t) {
    if (!has(channel)) return;
    Axis& a = at(channel);
    leave_out_older(a, t.now);
    const bool moves = a.feedback.moving;
    const Duration period = bus_.timing.poll_period;
    (void)polls_.every(item(channel), pace_.period(period, moves), t.now + pace_.period(period, false));
    polls_.quick(item(channel), moves && !pace_.close());
    emit(channel, t);
    look_for_power(channel, t);
}

/// What a state says that is older than the last acknowledged order is left out.
template <class Message, int Channels>
void Dialogue<Message, Channels>::leave_out_older(Axis& a, Instant now) const {
    AxisFeedback& fb = a.feedback;
    if (now < a.off_until && fb.power == AxisFeedback::Power::on) fb.power = AxisFeedback::Power::off;
    if (now >= a.rest_until || fb.moving || fb.fault || fb.power != AxisFeedback::Power::on) return;
    if (std::llabs(fb.position - a.target) <= play) return;
    fb.moving = true;
    fb.target_reached = false;
}

/// Many drives acknowledge an enable at once and come on later, for a brake or a test; a motion in between would be refused.
template <class Message, int Channels>
void Dialogue<Message, Channels>::look_for_power(int channel, Turn& t) {
    Axis& a = at(channel);
    const bool on = a.feedback.power == AxisFeedback::Power::on;
    if (a.enabling.empty() || (!on && t.now < a.on_by)) return;
    for (const Ticket ticket : std::exchange(a.enabling, {})) {
        if (on) {
            tickets.accepted(ticket, t.out);
        } else {
            tickets.failed(ticket, Reason::interrupted,
                           fmt::format("the drive has acknowledged the enable and has not come on within {} s",
                                       std::chrono::duration_cast<std::chrono::seconds>(power_shows_within).count()),
                           t.out);
        }
    }
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::emit(int channel, Turn& t) {
    AxisFeedback& fb = at(channel).feedback;
    fb.at = t.now;
    for (const AxisSetup& a : setup_.axes)
        if (a.channel == channel) t.out.feedback.push_back({a.id, fb});
}

// --- time-outs -------------------------------------------------------------------------------------------------------------------

template <class Message, int Channels>
void Dialogue<Message, Channels>::on_deadline(Turn& t) {
    const auto late = exchange_.on_deadline(t.now, bus_.counters);
    if (late == Late::repeat) return transmit(t);
    if (late == Late::no) return;
    const Ask ask = exchange_.request();
    bus_.turns.ended(slot());
    late_.add(this->mark_of(ask.message));
    if (ask.why == Ask::Why::stop && !stops_.empty()) stops_.remove(stops_.first());
    if (ask.why == Ask::Why::step && job_ && job_->number == ask.job) {
        at(ask.channel).followed = {};
        job_.reset();
    }
    tickets.failed(ask.ticket, Reason::no_answer, this->words_of(ask.message) + " was not answered: whether the drive took it is not known",
                   t.out);
    if (presence.silent(t.now) == Presence::Silence::counted) return;
    // Stops that wait are sent all the same: a drive that does not answer may still receive them.
    end_all(Reason::no_answer, "the drive does not answer", t);
    presence.report("the drive does not answer", t.out);
}

template <class Message, int Channels>
void Dialogue<Message, Channels>::end_all(Reason reason, std::string_view why, Turn& t) {
    queue_.clear();
    polls_.clear();
    set_points_.clear();
    job_.reset();
    for (Axis& a : axes_) {
        a.followed = {};
        a.enabling.clear();
    }
    tickets.fail_all(reason, why, t.out);
}

}  // namespace axisgate::drive
