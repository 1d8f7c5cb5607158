// Drive: what it sends next, and what answers and silences mean.
// In: places on the line, telegrams, time. Out: requests, feedback, links. Never asks two things at once.
#include "adapters/example/drive.hpp"

#include <fmt/core.h>

#include <cstdio>

#include "gateway/core/wire_time.hpp"

namespace axisgate::example {
using Kind = Telegram::Kind;
using Phase = Presence::Phase;

void Line::take(const LineSetup& setup) {
    timing = drive::timing_of(setup.timing, drive::Timing{.reply_timeout = std::chrono::milliseconds(60)});
    on_wire = wire_time(2 * longest * setup.bits_per_byte, setup.bit_rate);
    turns.set({.pause = timing.pause});
}

Drive::Drive(Line& line, const DriveSetup& setup, int address, std::size_t slot)
    : line_(line), setup_(setup), address_(address), slot_(slot), presence_(setup.id, line.timing) {}

void Drive::line_up(Turn& t) { presence_.begin(t.now); }

void Drive::line_down(std::string_view why, Turn& t) {
    presence_.close();
    exchange_.drop();
    stops_.clear();
    queue_.clear();
    polls_.clear();
    set_points_.clear();
    job_.reset();
    tickets_.fail_all(Reason::line_down, why, t.out);
    presence_.report(std::string(why), t.out);
}

void Drive::set_axes(const DriveSetup& setup, Turn& t) {
    const auto in = [](const DriveSetup& s, const AxisSetup& a) {
        return std::ranges::any_of(s.axes, [&](const AxisSetup& x) { return x.id == a.id && x.channel == a.channel; });
    };
    for (const AxisSetup& a : setup_.axes) {
        if (in(setup, a)) continue;
        const auto its = [&](const Command& w) { return w.axis == a.id; };
        tickets_.fail_axis(a.id, Reason::line_down, "the axis was removed or changed", t.out);
        (void)queue_.interrupt(its, "its removal", tickets_, t);
        set_points_.forget(a.id);
        if (job_ && its(job_->command)) job_.reset();
        polls_.drop(static_cast<drive::Polls::Item>(a.channel));
        if (std::exchange(axes_[static_cast<std::size_t>(a.channel)], {}).moving)  // nobody could stop it any more
            (void)stops_.add({no_ticket, {address_, a.channel, "R23", Kind::value, "1"}});
    }
    for (const AxisSetup& a : setup.axes)
        if (presence_.online() && !in(setup_, a))
            (void)polls_.every(static_cast<drive::Polls::Item>(a.channel), line_.timing.poll_period, t.now);
    setup_ = setup;
}

void Drive::follow(const SetPoint& p) {
    if (presence_.online()) set_points_.put(p);
}

void Drive::submit(const Command& c, Turn& t) {
    if (is_urgent(c.body) || drive::is_motion(c.body)) set_points_.forget(c.axis);
    if (drive::admit(c, setup_.name, presence_, queue_, tickets_, t) != drive::Admission::urgent) return;
    const bool off = std::holds_alternative<Disable>(c.body);
    const auto ends = [&](const Command& w) {
        return w.axis == c.axis && (drive::is_motion(w.body) || (off && std::holds_alternative<Enable>(w.body)));
    };
    (void)queue_.interrupt(ends, name_of(c.body), tickets_, t);
    if (job_ && ends(job_->command)) {
        tickets_.failed(job_->command.ticket, Reason::interrupted, drive::CommandQueue::interrupted_by(name_of(c.body)), t.out);
        job_.reset();
    }
    followed_[static_cast<std::size_t>(channel_of(c.axis))] = {};
    exchange_.no_repeats();
    const Step stop{off ? "R20" : "R23", Kind::value, std::holds_alternative<QuickStop>(c.body) ? "1" : "0"};
    if (!stops_.add({c.ticket, telegram(c.axis, stop)}))
        tickets_.refused(c.ticket, Reason::busy, "8 stops are on their way already", t.out);
}

drive::Want Drive::wants(Instant now) const noexcept {
    if (exchange_.active() || presence_.is(Phase::down)) return drive::Want::nothing;
    if (!stops_.empty()) return drive::Want::urgent;
    if (!presence_.online()) return presence_.probe_due(now) ? drive::Want::probe : drive::Want::nothing;
    if (job_ || !queue_.empty() || !set_points_.empty()) return drive::Want::command;
    const bool moves = std::ranges::any_of(axes_, &AxisFeedback::moving);
    return !polls_.due(now) ? drive::Want::nothing : moves && !pace_.close() ? drive::Want::quick_poll : drive::Want::poll;
}

void Drive::go(Turn& t) {
    if (!stops_.empty()) {
        return send({Ask::Why::stop, stops_.first()->telegram, stops_.first()->ticket}, line_.timing.retries, t);
    }
    if (!presence_.online()) {
        presence_.probe_sent();
        return send({Ask::Why::probe, {address_, 1, "R01", Kind::read, {}}, no_ticket}, 0, t);
    }
    while (!job_ && !queue_.empty())
        begin(queue_.pop(), t);
    const bool poll_first = streamed_last_ && polls_.due(t.now);  // where the axis is must be seen, however fast set-points come
    streamed_last_ = !job_ && !set_points_.empty() && !poll_first;
    if (streamed_last_) job_ = job_for(set_points_.take());
    if (job_) {
        Step& s = job_->steps[job_->at];
        if (std::exchange(s.from_here, false))
            s.text = std::to_string(std::atoll(s.text.c_str()) + axes_[static_cast<std::size_t>(channel_of(job_->command.axis))].position);
        // A streamed set-point is not repeated: the next one is newer.
        const bool once = std::holds_alternative<Native>(job_->command.body) || job_->command.ticket == no_ticket;
        return send({Ask::Why::step, telegram(job_->command.axis, s), job_->command.ticket}, once ? 0 : line_.timing.retries, t);
    }
    if (const auto channel = polls_.next(t.now))
        send({Ask::Why::poll, {address_, static_cast<int>(*channel), "S00", Kind::read, {}}, no_ticket}, 0, t);
}

Telegram Drive::telegram(AxisId axis, const Step& s) const { return {address_, channel_of(axis), s.item, s.kind, s.text}; }

/// By what an answer is known: not by its value.
static Telegram mark_of(const Telegram& t) { return {t.address, t.axis, t.item, Kind::read, {}}; }

void Drive::send(Ask ask, int retries, Turn& t) {
    // A late answer to the same question would be taken for the new one: something else is asked before, whose answer comes behind it.
    // A stop waits for nothing.
    if (ask.why != Ask::Why::stop && late_.has(mark_of(ask.telegram))) {
        const bool other = late_.has({address_, 1, "R01", Kind::read, {}});
        ask = {Ask::Why::poll, {address_, 1, other ? "R02" : "R01", Kind::read, {}}, no_ticket};
        if (late_.has(ask.telegram)) late_.clear();
    }
    line_.turns.began(slot_, ask.why == Ask::Why::probe);
    const std::string text = text_of(ask.telegram, true);
    t.out.send(Frame::run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}), ask.why == Ask::Why::stop ? Priority::urgent
                                                                                              : ask.why == Ask::Why::step
                                                                                                  ? Priority::command
                                                                                                  : Priority::poll);
    exchange_.begin(std::move(ask), t.now, line_.timing.reply_timeout + line_.on_wire, retries);
}

void Drive::on_telegram(const Telegram& answer, Turn& t) {
    const Telegram& asked = exchange_.request().telegram;
    const bool fits = exchange_.active() && mark_of(asked) == mark_of(answer) &&
                      (answer.kind == Kind::refused || asked.kind == Kind::read || asked.text == answer.text);
    if (!fits) {
        ++line_.counters.unexpected;
        return presence_.heard(t.now);
    }
    if (exchange_.tries() > 1) late_.add(mark_of(asked));
    const Ask ask = exchange_.answered(line_.counters);
    line_.turns.ended(slot_);
    line_.turns.heard(t.now);
    presence_.answered();
    if (!late_.has(mark_of(ask.telegram))) late_.clear();
    answered(ask, answer, t);
}

void Drive::answered(const Ask& ask, const Telegram& answer, Turn& t) {
    if (answer.kind == Kind::refused) ++line_.counters.refused;
    if (!presence_.online()) {
        presence_.found();
        presence_.made_ready();
        presence_.report("example drive, model " + (ask.why == Ask::Why::probe ? answer.text : std::string("not read")), t.out);
        for (const AxisSetup& a : setup_.axes)
            (void)polls_.every(static_cast<drive::Polls::Item>(a.channel), line_.timing.poll_period, t.now);
    }
    if (answer.item == "S00" && answer.kind == Kind::value) learn(answer.axis, answer.text, t);
    if (ask.why == Ask::Why::step && job_ && job_->command.ticket == ask.ticket) return step_answered(answer, t);
    if (ask.why != Ask::Why::stop) return;
    if (!stops_.empty() && stops_.first()->ticket == ask.ticket) stops_.remove(stops_.first());
    (void)polls_.soon(static_cast<drive::Polls::Item>(answer.axis), t.now);
    if (answer.kind == Kind::value) tickets_.accepted(ask.ticket, t.out);
    tickets_.refused(ask.ticket, Reason::drive_refused, "the drive refuses the stop with code " + answer.text, t.out);
}

void Drive::on_deadline(Turn& t) {
    const auto late = exchange_.on_deadline(t.now, line_.counters);
    if (late == drive::Late::repeat) {
        const std::string text = text_of(exchange_.request().telegram, true);
        return t.out.send(Frame::run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
    }
    if (late == drive::Late::no) return;
    const Ask ask = exchange_.request();
    line_.turns.ended(slot_);
    late_.add(mark_of(ask.telegram));
    if (ask.why == Ask::Why::stop && !stops_.empty()) stops_.remove(stops_.first());
    if (ask.why == Ask::Why::step && job_ && job_->command.ticket == ask.ticket) {
        followed_[static_cast<std::size_t>(channel_of(job_->command.axis))] = {};
        job_.reset();
    }
    tickets_.failed(ask.ticket, Reason::no_answer, ask.telegram.item + " was not answered: whether the drive took it is not known", t.out);
    const auto silence = presence_.silent(t.now);
    if (silence == Presence::Silence::counted) return;
    // Stops that were not sent yet still are: a drive that is not heard may hear.
    queue_.clear();
    polls_.clear();
    set_points_.clear();
    job_.reset();
    tickets_.fail_all(Reason::no_answer, "the drive does not answer", t.out);
    presence_.report("the drive does not answer", t.out);
}

int Drive::channel_of(AxisId axis) const noexcept {
    const auto it = std::ranges::find(setup_.axes, axis, &AxisSetup::id);
    return it == setup_.axes.end() ? 1 : it->channel;
}

/// S00: "bits,position,velocity,demand,fault". Bits: 0 on, 1 moves, 2 at its target, 3 referenced.
void Drive::learn(int channel, std::string_view text, Turn& t) {
    unsigned bits = 0, fault = 0;
    long long position = 0, velocity = 0, demand = 0;
    if (std::sscanf(std::string(text).c_str(), "%u,%lld,%lld,%lld,%u", &bits, &position, &velocity, &demand, &fault) != 5) return;
    AxisFeedback& fb = axes_[static_cast<std::size_t>(channel)];
    fb.power = bits & 1 ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    fb.moving = bits & 2;
    fb.target_reached = bits & 4;
    fb.referenced = bits & 8;
    fb.homing_attained = fb.homing_attained && fb.referenced;
    fb.fault = fault != 0;
    fb.error_code = static_cast<std::uint16_t>(fault);
    fb.native_status = bits;
    fb.position = position;
    fb.velocity = velocity;
    fb.position_demand = demand;
    fb.demand_source = bits & 1 ? DemandSource::drive : DemandSource::none;
    (void)polls_.every(static_cast<drive::Polls::Item>(channel), pace_.period(line_.timing.poll_period, fb.moving),
                       t.now + pace_.period(line_.timing.poll_period, false));
    polls_.quick(static_cast<drive::Polls::Item>(channel), fb.moving && !pace_.close());
    emit(channel, t);
}

void Drive::emit(int channel, Turn& t) {
    AxisFeedback& fb = axes_[static_cast<std::size_t>(channel)];
    fb.at = t.now;
    for (const AxisSetup& a : setup_.axes)
        if (a.channel == channel) t.out.feedback.push_back({a.id, fb});
}

}  // namespace axisgate::example
