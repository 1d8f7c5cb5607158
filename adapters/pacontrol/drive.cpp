// Drive, part turns: whose turn it is on the line, the axes' queues, and the run of jobs.
// In: commands, bytes, deadlines. Out: the next exchange; one result per command.
// Order: stops; what brings the line back into step; polls for an end of processing; renewals of manual moves; commands; polls. After
// four commands in a row one poll gets its turn, so that a busy line still shows where the axes are.
#include "adapters/pacontrol/drive.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "adapters/pacontrol/wire_number.hpp"
#include "gateway/drive/option_reader.hpp"
#include "gateway/drive/tickets.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr std::size_t channels = 16;
constexpr std::uint8_t commands_per_poll = 4;
constexpr Duration renew_period = std::chrono::milliseconds(400);  // the control wants it within 1 s [L3606]; a lost one may be repeated
constexpr Duration processing_period = std::chrono::milliseconds(20);
}  // namespace

DriveOptions drive_options(const DriveSetup& d) {
    DriveOptions o;
    drive::OptionReader read(d.options);
    o.online_auto = read.flag("online", true, "auto", "manual");
    o.give_back_auto = read.flag("give_back", true, "auto", "never");
    o.parameters_wait = read.flag("when", false, "wait", "refuse");
    o.set_by_g26 = read.flag("set_position", false, "g26", "g29");
    o.release = read.flag("reference", false, "release", "keep");
    o.wait_limit = read.milliseconds("when_timeout_ms", 100, 3'600'000, o.wait_limit);
    o.processing_limit = read.milliseconds("processing_timeout_ms", 100, 3'600'000, o.processing_limit);
    std::string_view order = read.text("reference_order");
    while (!order.empty()) {
        int n = 0;
        const auto [p, ec] = std::from_chars(order.data(), order.data() + order.size(), n);
        const auto used = static_cast<std::size_t>(p - order.data());
        if (ec != std::errc{} || n < 1 || n > 16 || (used < order.size() && order[used] != ',')) {
            read.fault("option reference_order: write channels 1 to 16 with commas, as in 3,1,2; the channels' own order is used");
            o.reference_order.clear();
            break;
        }
        o.reference_order.push_back(n);
        order.remove_prefix(std::min(order.size(), used + 1));
    }
    o.faults = read.take_faults();
    return o;
}

Drive::Drive(const Catalogue& catalogue, const Elements& elements, AdapterCounters& counters, const LineForm& line, const DriveSetup& setup)
    : catalogue_(catalogue),
      elements_(elements),
      counters_(counters),
      line_(line),
      setup_(setup),
      options_(drive_options(setup)),
      axes_(channels),
      presence_(setup.id, line.timing),
      notices_(setup.id) {
    for (std::size_t i = 0; i < channels; ++i)
        axes_[i].channel = static_cast<int>(i) + 1;
    for (const AxisSetup& a : setup.axes) {
        if (a.channel >= 1 && a.channel <= static_cast<int>(channels)) axes_[static_cast<std::size_t>(a.channel) - 1].id = a.id;
    }
    if (line_.check == CheckMode::zero) form_ = CheckForm::zero;
}

void Drive::set_axes(const DriveSetup& setup, Turn& t) {
    setup_ = setup;
    for (Axis& a : axes_) {
        const auto it = std::ranges::find(setup.axes, a.channel, &AxisSetup::channel);
        const AxisId id = it == setup.axes.end() ? no_axis : it->id;
        if (id == a.id) continue;
        const bool moves = a.running || a.motion.active();
        fail_axis(a, Reason::line_down, "the axis was removed or changed", t);
        const int channel = a.channel;
        a = Axis{};
        a.channel = channel;
        a.id = id;
        first_cycle_ = true;
        if (!moves || !presence_.is(Phase::ready) || stops_.size() >= stop_limit) continue;
        Stop s;  // nobody could stop it any more
        s.axis = place(a);
        stops_.push_back(s);
    }
    polls_.clear();
}

Axis* Drive::axis_of(AxisId id) noexcept {
    if (id == no_axis) return nullptr;
    const auto it = std::ranges::find(axes_, id, &Axis::id);
    return it == axes_.end() ? nullptr : &*it;
}

void Drive::submit(const Command& c, Turn& t) {
    Axis* a = axis_of(c.axis);
    const auto answer = [&](Reason reason, std::string text) { drive::Tickets::refuse(c, reason, std::move(text), t.out); };
    if (!a) return answer(Reason::line_down, "this axis is not on the line, or its channel is not 1 to 16");
    if (presence_.is(Phase::down)) return answer(Reason::line_down, "the line is down");
    if (is_urgent(c.body)) return submit_stop(*a, c, t);
    if (presence_.is(Phase::absent)) return answer(Reason::no_answer, fmt::format("the PA-CONTROL {} does not answer", setup_.name));
    if (a->queue.size() >= Axis::queue_limit) {
        return answer(Reason::busy, fmt::format("{} commands of this axis wait already: wait for their answers", Axis::queue_limit));
    }
    a->queue.push_back(c);
}

// --- turns -----------------------------------------------------------------------------------------------------------------------

void Drive::pump(Turn& t) {
    if (presence_.is(Phase::down)) return;
    if (presence_.is(Phase::ready)) {
        if (wake_) run_waiting(t);
        for (Axis& a : axes_)
            take_next(a, t);
    }
    if (exchange_.active() || t.now < quiet_until_) return;
    if (stop_ready()) return send_stop(t);
    if (!presence_.is(Phase::ready)) {
        if (!presence_.probe_due(t.now)) return;
        presence_.probe_sent();
        return send(Purpose::probe, {code::get_state, 0, false, "0"}, 0, Priority::poll, t);
    }
    if (processing_.active) {
        if (send_native_poll(t) || processing_.next_poll > t.now) return;
        processing_.next_poll = t.now + processing_period;
        if (!processing_.hidden) return send_poll(Purpose::processing, processing_.axis, Priority::command, t);
        return send(Purpose::processing, {code::status_axis, static_cast<std::uint32_t>(processing_.axis) + 1, false, "0"},
                    processing_.axis, Priority::command, t);
    }
    if (look_due_) return send_poll(Purpose::look, 0, Priority::command, t);
    // Input 0 does not exist: the answer is "inadmissible input", which nothing else that is sent gives. What comes before it is late.
    if (out_of_step_) return send(Purpose::barrier, {code::get_input, 0, false, "0"}, 0, Priority::command, t);
    for (Axis& a : axes_) {
        if (a.renew_at > t.now) continue;
        a.renew_at = t.now + renew_period;
        return send(Purpose::renew, {code::manual_renew, static_cast<std::uint32_t>(a.channel), true, "0"}, place(a), Priority::command, t);
    }
    const bool poll = poll_wanted(t.now);
    if (!(poll && commands_in_a_row_ >= commands_per_poll) && send_job(t)) {
        ++commands_in_a_row_;
        return;
    }
    consider_give_back(t);
    if (exchange_.active()) return;
    if (poll) {
        commands_in_a_row_ = 0;
        send_next_poll(t);
    }
}

Instant Drive::deadline(Instant now) const noexcept {
    if (presence_.is(Phase::down)) return never;
    Instant d = supervise_at_;
    for (const Axis& a : axes_) {
        if (a.job.want == Job::Want::wait) d = std::min(d, a.job.limit);
    }
    if (processing_.active) d = std::min(d, processing_.limit);
    if (exchange_.active()) return std::min(d, exchange_.deadline);
    if (now < quiet_until_) return std::min(d, quiet_until_);
    if (!presence_.is(Phase::ready)) return std::min(d, presence_.deadline());
    if (processing_.active) return std::min(d, processing_.next_poll);
    for (const Axis& a : axes_)
        d = std::min(d, a.renew_at);
    return std::min(d, cycle_at_);
}

void Drive::on_deadline(Turn& t) {
    if (presence_.is(Phase::down)) return;
    if (exchange_.active() && exchange_.deadline <= t.now) silent(t);
    if (supervise_at_ <= t.now) supervise(t);
    for (Axis& a : axes_) {
        if (a.job.want == Job::Want::wait && a.job.limit <= t.now) job_late(a, t);
    }
    if (processing_.active && processing_.limit <= t.now) {
        const std::size_t at = processing_.axis, owner = processing_.owner;
        const std::uint16_t what = processing_.code;
        processing_ = {};
        out_of_step_ = true;
        Axis& a = axes_[at];
        const std::string text = fmt::format("{:04X}: end of processing was not reported within {} s: what became of it is not known", what,
                                             milliseconds_of(options_.processing_limit) / 1000);
        notice(Severity::warning, "protocol", 0, text, t, a.id);
        if (a.motion.active()) end_motion(a, false, Reason::no_answer, text, t);
        if (axes_[owner].job.processing) job_over(axes_[owner], Outcome::failed, Reason::no_answer, text, t);
    }
}

// --- jobs ------------------------------------------------------------------------------------------------------------------------

void Drive::take_next(Axis& a, Turn& t) {
    // Commands that end without an exchange let the next one follow at once; the queue's bound is the loop's.
    while (!a.job.active() && !a.queue.empty()) {
        Command c = std::move(a.queue.front());
        a.queue.pop_front();
        a.job = Job{};
        a.job.command = std::move(c);
        start_job(a, t);
    }
}

void Drive::start_job(Axis& a, Turn& t) {
    Job& j = a.job;
    const CommandBody body = j.command.body;
    if (a.missing) {
        j.kind = Job::Kind::read;
        return refuse(a, Reason::wrong_state,
                      fmt::format("the control says that it has no axis {} (20h): system parameter 2 is the number of axes", a.channel), t);
    }
    if (std::holds_alternative<Enable>(body)) {
        j.kind = Job::Kind::enable;
    } else if (std::holds_alternative<ResetFault>(body)) {
        j.kind = Job::Kind::reset;
    } else if (std::holds_alternative<Home>(body)) {
        j.kind = Job::Kind::home;
    } else if (std::holds_alternative<SetPosition>(body)) {
        j.kind = Job::Kind::origin;
    } else if (const auto* move = std::get_if<Move>(&body)) {
        j.kind = Job::Kind::move;
        return start_move(a, *move, t);
    } else if (const auto* together = std::get_if<StartTogether>(&body)) {
        j.kind = Job::Kind::together;
        return start_together(a, *together, t);
    } else if (const auto* read = std::get_if<ReadParameter>(&body)) {
        j.kind = Job::Kind::read;
        j.point = read->point;
    } else if (const auto* write = std::get_if<WriteParameter>(&body)) {
        j.kind = Job::Kind::write;
        j.point = write->point;
    } else if (const auto* native = std::get_if<Native>(&body)) {
        j.kind = Job::Kind::native;
        return start_native(a, *native, t);
    } else if (const auto* action = std::get_if<Action>(&body)) {
        j.kind = Job::Kind::single;
        return start_action(a, *action, t);
    } else {
        j.kind = Job::Kind::read;
        return refuse(a, Reason::not_supported, "this is not a command of a PA-CONTROL", t);
    }
    run(a, nullptr, t);
}

void Drive::run(Axis& a, const Reply* reply, Turn& t) {
    switch (a.job.kind) {
        case Job::Kind::none:
            return;
        case Job::Kind::enable:
            return run_enable(a, reply, t);
        case Job::Kind::reset:
            return run_reset(a, reply, t);
        case Job::Kind::home:
            return run_home(a, reply, t);
        case Job::Kind::origin:
            return run_origin(a, reply, t);
        case Job::Kind::move:
            return run_move(a, reply, t);
        case Job::Kind::together:
            return run_together(a, reply, t);
        case Job::Kind::read:
        case Job::Kind::write:
            return run_value(a, reply, t);
        case Job::Kind::native:
            return run_native(a, reply, t);
        case Job::Kind::single:
            return run_single(a, reply, t);
        case Job::Kind::mode:
            return run_mode(a, reply, t);
    }
}

void Drive::ask(Axis& a, Request request) {
    a.job.request = std::move(request);
    a.job.want = Job::Want::send;
    a.job.tries = 0;
}
void Drive::ask(Axis& a, std::uint16_t what, std::uint32_t parameter, Turn&) {
    const CommandInfo* c = command_info(what);
    ask(a, {what, parameter, c && (c->data == Carries::real || c->answer == Carries::real), "0"});
}
void Drive::ask_real(Axis& a, std::uint16_t what, std::uint32_t parameter, std::string data, Turn&) {
    ask(a, {what, parameter, true, std::move(data)});
}
void Drive::wait(Axis& a, Instant limit) {
    a.job.want = Job::Want::wait;
    a.job.limit = limit;
}

bool Drive::send_job(Turn& t) {
    for (std::size_t n = 0; n < axes_.size(); ++n) {
        Axis& a = axes_[job_at_];
        job_at_ = (job_at_ + 1) % axes_.size();
        Job& j = a.job;
        if (j.want != Job::Want::send || j.in_flight) continue;
        j.in_flight = true;
        j.want = Job::Want::nothing;
        ++j.tries;
        if (j.request.code == code::abort_online) leaving_ = true;  // whoever asks for it here, it is no surprise
        if (j.poll) {
            send_poll(Purpose::job, place(a), Priority::command, t);
        } else if (!j.raw.empty()) {
            send_raw(j.raw, Purpose::job, place(a), t);
            exchange_.request = j.request;
        } else {
            send(Purpose::job, j.request, place(a), Priority::command, t);
        }
        return true;
    }
    return false;
}

/// A poll that a client asked for is the one thing of a client that may cross the line while a command is being processed.
bool Drive::send_native_poll(Turn& t) {
    for (Axis& a : axes_) {
        if (!a.job.poll || a.job.want != Job::Want::send) continue;
        a.job.in_flight = true;
        a.job.want = Job::Want::nothing;
        send_poll(Purpose::job, place(a), Priority::command, t);
        return true;
    }
    return false;
}

void Drive::job_answered(Axis& a, const Reply& reply, Turn& t) {
    Job& j = a.job;
    const bool orphan = !j.active() || !j.in_flight;  // a stop has ended it meanwhile
    j.in_flight = false;
    if (!orphan && j.poll && processing_.active) {
        run_native(a, &reply, t);
        if (reply.end && !processing_.hidden) processing_over(reply, t);
        return;
    }
    const bool goes_on = reply.quit == 0 && !reply.end;
    if (goes_on) {
        processing_ = {};
        processing_.active = true;
        processing_.foreign = orphan;
        const bool for_another = !orphan && j.kind == Job::Kind::single && !j.places.empty();
        processing_.owner = place(a);
        processing_.axis = for_another ? j.places[j.at] : place(a);
        processing_.code = orphan ? std::uint16_t{0} : j.request.code;
        processing_.next_poll = t.now;
        processing_.limit = t.now + options_.processing_limit;
    }
    if (orphan) return;
    if (j.unknown) {
        if (reply.quit == 0) learn_position(a, number_of(reply).value_or(0), t);
        return job_over(a, Outcome::failed, Reason::no_answer,
                        fmt::format("{}; the position read back is {}", j.text, reply.quit == 0 ? reply.data : "not known"), t);
    }
    if (goes_on) {
        j.processing = j.begun = true;
        if (reply.real && (j.request.code == code::move_absolute_wait || j.request.code == code::move_relative_wait)) {
            learn_position(a, number_of(reply).value_or(0), t);
        }
        if (j.kind == Job::Kind::home) {
            begin_motion(a, {Motion::Kind::reference, 0, false, false, exchanges_}, t);
            if (!j.command.until_done) {
                const Ticket ticket = std::exchange(j.command.ticket, no_ticket);
                result(a, ticket, Outcome::accepted, Reason::none, "", t);
            }
        }
        if (j.kind == Job::Kind::single && !j.places.empty()) {
            begin_motion(axes_[j.places[j.at]], {Motion::Kind::reference, 0, false, false, exchanges_}, t);
            if (!j.command.until_done) {  // nobody waits for the end: it has begun
                const Ticket ticket = std::exchange(j.command.ticket, no_ticket);
                result(a, ticket, Outcome::accepted, Reason::none, "", t);
            }
        }
        if (j.kind == Job::Kind::native) run_native(a, &reply, t);  // the answer is the answer; the polls go on without it
        return;
    }
    run(a, &reply, t);
}

/// No answer to the present request.
void Drive::job_silent(Axis& a, Turn& t) {
    Job& j = a.job;
    if (!j.active() || !j.in_flight) return;
    j.in_flight = false;
    const CommandInfo* c = command_info(j.request.code);
    const bool repeatable = c && c->repeatable && j.kind != Job::Kind::native;
    if (repeatable && j.tries <= line_.timing.retries) {
        ++counters_.retries;
        j.want = Job::Want::send;
        return;
    }
    if (j.kind == Job::Kind::enable || j.kind == Job::Kind::reset || j.kind == Job::Kind::mode) {
        // What became of a change of mode is told by the status: it decides anew.
        if (++j.rounds <= line_.timing.retries) return wait(a, t.now + std::chrono::seconds(2));
    }
    const std::string what = j.poll ? "the poll" : describe(j.request);
    if (j.unknown) return job_over(a, Outcome::failed, Reason::no_answer, j.text + "; the position could not be read back", t);
    if (!repeatable && c && c->online_only && c->parameter == Takes::axis && j.kind != Job::Kind::native) {
        j.unknown = true;
        j.text = fmt::format("{} was not acknowledged: whether the control carries it out is not known", what);
        a.reached = false;
        return ask(a, code::position, static_cast<std::uint32_t>(a.channel), t);
    }
    job_over(a, Outcome::failed, Reason::no_answer,
             fmt::format("{} was not acknowledged{}", what, repeatable ? "" : ": whether the control carries it out is not known"), t);
}

void Drive::run_waiting(Turn& t) {
    wake_ = false;
    for (Axis& a : axes_) {
        if (a.job.active() && a.job.want == Job::Want::wait) {
            a.job.want = Job::Want::nothing;
            run(a, nullptr, t);
        }
    }
}

void Drive::job_late(Axis& a, Turn& t) {
    const bool value = a.job.kind == Job::Kind::read || a.job.kind == Job::Kind::write;
    job_over(a, value ? Outcome::refused : Outcome::failed, Reason::wrong_state,
             fmt::format("{}the control did not get there in time; operating status {}", a.job.text.empty() ? "" : a.job.text + ": ",
                         status_text(mode_)),
             t);
}

void Drive::job_over(Axis& a, Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code, Value value,
                     std::vector<std::uint8_t> bytes) {
    if (!a.job.active()) return;
    const Ticket ticket = a.job.command.ticket;
    a.job = Job{};
    result(a, ticket, outcome, reason, std::move(text), t, code, std::move(value), std::move(bytes));
}

bool Drive::ended_by_quit(Axis& a, const Reply& reply, Turn& t, std::string_view advice, Reason reason) {
    if (reply.quit == 0) return false;
    ++counters_.refused;
    if (a.job.request.code == code::abort_online) leaving_ = false;
    if (reply.quit == quit::not_switched_on && a.on) {
        a.on = false;  // the control says IDLE or SAFE [L4071]: switched off at the control
        emit(a, t);
    }
    std::string text = fmt::format("{}: {}", describe(a.job.request), describe_quit(reply.quit));
    if (reply.quit == quit::inadmissible) text += fmt::format(", which is {}", status_text(reply.status));
    if (reply.error != 0) text += fmt::format("; PA-CONTROL error E{}", reply.error);
    if (!advice.empty()) text += fmt::format(": {}", advice);
    job_over(a, Outcome::refused, reason, std::move(text), t, reply.quit);
    return true;
}

/// BE = 1 for what was being processed.
void Drive::processing_over(const Reply& reply, Turn& t) {
    const Processing was = processing_;
    processing_ = {};
    cycle_at_ = t.now;
    Axis& a = axes_[was.owner];
    if (!a.job.active() || !a.job.processing || was.foreign) return;  // the next cycle sees what became of it
    a.job.processing = false;
    run(a, &reply, t);
}

}  // namespace axisgate::pacontrol
