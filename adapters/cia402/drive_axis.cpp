#include "adapters/cia402/drive_axis.hpp"

#include <fmt/format.h>

#include "adapters/cia402/drive_exchange.hpp"
#include "adapters/cia402/drive_handshake.hpp"

#include <cstdlib>

namespace axisgate::cia402_drive {
namespace {
/// In the node's object dictionary.
Address address_in_node(const Step& s, std::size_t axis) { return s.literal ? s.address : of_axis(s.address, axis); }

/// A relative move counts from the target that was reached: the position of a drive at rest differs from it by its following error, and
/// some drives show it late, so that the differences of several moves would add up. The engine has checked the way from the actual
/// position; where the way from the target leads out of the site's limits, the actual position counts.
std::optional<std::int64_t> counted_from(const AxisKnown& known, const Axis::Limits& limits, const CommandBody& body) {
    const auto* m = std::get_if<Move>(&body);
    if (!m || m->kind != Move::Kind::relative || known.order != Order::position || !known.at_target) return std::nullopt;
    const std::int64_t to = saturated_sum(*known.target, m->target);
    if ((limits[0] && to < *limits[0]) || (limits[1] && to > *limits[1])) return std::nullopt;
    return known.target;
}
}  // namespace

using drive::Want;
using Phase = Presence::Phase;

void Axis::forget() {
    queue_.clear();
    job_.reset();
    stream.end();
    feedback.forget();
    turns.forget();
    rates.forget();
}

bool Axis::submit(const Command& c, Turn& t) {
    if (is_urgent(c.body) || drive::is_motion(c.body) || std::holds_alternative<Enable>(c.body) ||
        std::holds_alternative<SetPosition>(c.body)) {
        stream.end();
        if (job_ && job_->stream) job_.reset();
    }
    if (drive::admit(c, node.setup.name, node.presence, queue_, node.tickets, t) != drive::Admission::urgent) return false;
    const bool off = std::holds_alternative<Disable>(c.body);
    const auto ends = [&](const Command& w) {
        return drive::is_motion(w.body) || std::holds_alternative<SetPosition>(w.body) || (off && std::holds_alternative<Enable>(w.body));
    };
    (void)queue_.interrupt(ends, name_of(c.body), node.tickets, t);
    if (job_ && ends(job_->command)) {
        node.tickets.failed(job_->command.ticket, Reason::interrupted, drive::CommandQueue::interrupted_by(name_of(c.body)), t.out);
        job_.reset();
    }
    if (!stops_.add({c, {}})) node.tickets.refused(c.ticket, Reason::busy, "8 stops are on their way already", t.out);
    return true;
}

Want Axis::wants(Instant now) const noexcept {
    if (const Stop* stop = stops_.first()) return !stop->job || now >= stop->job->wait_until ? Want::urgent : Want::nothing;
    if (!node.presence.is(Phase::ready)) return Want::nothing;
    if (node.stopped) return (job_ ? now >= job_->wait_until : !queue_.empty()) ? Want::command : Want::nothing;
    if (feedback.needs_error_code() || turns.wants(now) || rates.wants()) return Want::quick_poll;
    if (job_ ? now >= job_->wait_until : (!queue_.empty() || stream.waits()) && !feedback.doubts(now)) return Want::command;
    if (known.polled && now >= polled.due()) return Want::poll;
    return !job_ && now >= feedback.check_at() ? Want::poll : Want::nothing;
}
Instant Axis::wish() const noexcept {
    if (const Stop* stop = stops_.first()) return stop->job ? stop->job->wait_until : never;
    if (!node.presence.is(Phase::ready)) return never;
    if (known.polled && !node.stopped) return std::min(polled.due(), job_ ? job_->wait_until : never);
    if (job_) return job_->wait_until;
    if (node.stopped) return never;
    return queue_.empty() ? feedback.check_at() : std::min(feedback.check_at(), feedback.doubted_until());
}

std::optional<Ask> Axis::next(Turn& t) {
    const int retries = node.line.timing.retries;
    if (Stop* stop = stops_.first()) {
        if (!stop->job) {
            stop->job.emplace().command = stop->command;
            plan_stop(known, *stop->job);
        }
        return Ask{Ask::Why::stop, stop->job->steps[stop->job->at], stop->command.ticket, retries + Exchanges::after_start};
    }
    if (!node.stopped) {
        if (auto own = next_of_its_own(t)) return own;
    }
    while (!job_ && !queue_.empty() && (node.stopped || !feedback.doubts(t.now)))
        begin(queue_.pop(), t);
    if (!job_ && stream.waits() && !feedback.doubts(t.now)) job_ = stream.begin(t);
    if (job_ && t.now >= job_->wait_until) {
        const Step& s = job_->steps[job_->at];
        const bool once = std::holds_alternative<Native>(job_->command.body) && s.kind == Step::Kind::write;
        Ask ask{Ask::Why::step, here(*job_), job_->command.ticket, once || job_->stream ? 0 : retries};
        ask.once = once || job_->stream;
        return ask;
    }
    if (known.polled && t.now >= polled.due() && !node.stopped) return Ask{Ask::Why::poll, polled.next(), no_ticket, 0};
    if (t.now >= feedback.check_at() && !node.stopped)
        return Ask{Ask::Why::check, {Step::Kind::read, object::error_register, {}}, no_ticket, 0};
    return std::nullopt;
}

std::optional<Ask> Axis::next_of_its_own(Turn& t) {
    const int retries = node.line.timing.retries;
    if (feedback.needs_error_code()) return Ask{Ask::Why::error, {Step::Kind::read, object::error_code, {}}, no_ticket, 0};
    if (turns.wants(t.now)) return Ask{Ask::Why::turns, turns.next(), no_ticket, retries};
    if (rates.wants()) return Ask{Ask::Why::rates, rates.next(), no_ticket, retries};
    return std::nullopt;
}

void Axis::begin(Command command, Turn& t) {
    Job job;
    job.command = std::move(command);
    Reason reason = Reason::not_supported;
    const auto* action = std::get_if<Action>(&job.command.body);
    if (node.stopped && !(action && action->name.starts_with("nmt_")))
        return void(node.tickets.refused(job.command.ticket, Reason::wrong_state,
                                         "somebody else has stopped the node (NMT stop): it answers nothing until nmt_start starts it",
                                         t.out));
    job.counts_from = counted_from(known, limits_, job.command.body);
    std::string why = plan(node, known, place_, job, t.now, reason);
    if (!why.empty()) return void(node.tickets.refused(job.command.ticket, reason, std::move(why), t.out));
    job_ = std::move(job);
}

/// The next step of a job, its distance added to the position that the step before has read.
Step Axis::here(const Job& job) {
    Step s = job.steps[job.at];
    if (s.from_here) s.bytes = bytes_of(std::clamp<std::int64_t>(job.here + signed_of(s.bytes), INT32_MIN, INT32_MAX), 4);
    return s;
}

Axis::News Axis::answered(const Ask& ask, const canopen::SdoEnd& end, Turn& t) {
    switch (ask.why) {
        case Ask::Why::check:
            return feedback.deaf(t.now) ? News::deaf : News::none;
        case Ask::Why::error:
            feedback.error_code_read(end, t);
            return News::none;
        case Ask::Why::poll:
            (void)polled.answered(end, t);
            return News::none;
        case Ask::Why::turns:
            turns.answered(end.done(), t);
            return News::none;
        case Ask::Why::rates:
            rates.answered(end, t);
            return News::none;
        case Ask::Why::step:
            if (job_ && job_->command.ticket == ask.ticket && job_->at < job_->steps.size() &&
                address_in_node(job_->steps[job_->at], place_) == ask.step.address)
                return step_done(*job_, end, t);
            if (ask.step.kind == Step::Kind::write) rates.written(of_first_axis(ask.step.address), 0, false, t);  // of a job that has ended
            return News::none;
        case Ask::Why::stop:
            if (Stop* stop = stops_.first(); stop && stop->job && stop->command.ticket == ask.ticket) return step_done(*stop->job, end, t);
            return News::none;
        default:
            return News::none;
    }
}

void Axis::unanswered(const Ask& ask, Turn& t) {
    if (ask.step.kind == Step::Kind::write) rates.written(of_first_axis(ask.step.address), 0, false, t);  // the drive may have accepted it
    if (Stop* stop = stops_.first(); ask.why == Ask::Why::stop && stop) stops_.remove(stop);
    if (ask.why == Ask::Why::turns) turns.forget();
    if (ask.why == Ask::Why::poll) polled.begin_anew();
    if (ask.why == Ask::Why::step && job_) {
        if (job_->stream) stream.end();
        job_.reset();
    }
}

void Axis::withdraw() {
    if (!stops_.empty()) return;  // a stop takes the start bit back, or is newer than this job
    Stop stop;
    stop.command = Command{no_ticket, id_, Disable{}, false, {}};
    stop.job.emplace().command = stop.command;
    stop.job->word(0);
    (void)stops_.add(std::move(stop));
}

void Axis::take_back(CommandBody body, void (*planned)(const AxisKnown&, Job&)) {
    if (!stops_.empty()) return;  // a stop is newer than this job
    Stop stop;
    stop.command = Command{no_ticket, id_, std::move(body), false, {}};
    if (planned) {
        stop.job.emplace().command = stop.command;
        planned(known, *stop.job);
        if (stop.job->steps.empty()) return;
    }
    (void)stops_.add(std::move(stop));
}

void Axis::node_stopped(Turn& t) {
    constexpr std::string_view why = "somebody else has stopped the node (NMT stop): nmt_start starts it again";
    turns.forget();
    if (stream.on()) t.out.stream_ends.push_back({id_, Reason::interrupted, std::string(why)});
    stream.end();
    if (job_) node.tickets.failed(job_->command.ticket, Reason::interrupted, std::string(why), t.out);
    job_.reset();
}

void Axis::drop(const Job& job) noexcept {
    if (is_urgent(job.command.body)) {
        stops_.remove(stops_.first());
    } else {
        job_.reset();
    }
}

Axis::News Axis::step_done(Job& job, const canopen::SdoEnd& end, Turn& t) {
    const Step s = here(job);
    const bool interpolation = s.address == object::cycle || s.address == object::cycle_index;
    // A drive without 60C2h has no interpolation time. One that does not accept it now would not move evenly.
    const bool other_time = job.stream && interpolation && end.abort == canopen::Abort::device_state && stream.has_another_time();
    if (!end.done() && (!s.optional || other_time)) {
        const std::string text =
            fmt::format("the drive refuses{}: {}", other_time ? " 60C2h, the time between two targets" : "", canopen::to_text(end));
        if (job.stream) {
            t.out.stream_ends.push_back({id_, Reason::drive_refused, text});
            stream.end();
        }
        node.tickets.refused(job.command.ticket, Reason::drive_refused, text, t.out, static_cast<std::int32_t>(end.abort));
        return drop(job), News::none;
    }
    const auto sent = [&](Address a) { return end.done() && s.kind == Step::Kind::write && s.address == a; };
    if (sent(object::controlword)) word_taken(known, job, s, t.now);
    if (sent(object::cycle)) known.interpolation.value = canopen::low_first(s.bytes);
    if (sent(object::cycle_index)) known.interpolation.index = signed_of(s.bytes);
    if (sent(object::mode)) {
        known.ordered_mode = static_cast<int>(signed_of(s.bytes));
        job.went.reset();  // a set-point that was sent before belongs to another mode
        job.begun = job.released = false;
    }
    if (!known.has_mode) known.mode = known.ordered_mode;
    if (end.done() && s.kind == Step::Kind::write)
        rates.written(of_first_axis(s.address), static_cast<std::int64_t>(canopen::low_first(s.bytes)),
                      std::holds_alternative<Move>(job.command.body), t);
    if (s.kind == Step::Kind::read) {
        job.here = signed_of(end.data);
        job.data = end.data;
    }
    // The status word that was just read is newer than the last PDO. It is shown before the command is answered, so that a client that is
    // informed of "enabled" finds the axis enabled.
    if (s.kind == Step::Kind::until && s.address == object::statusword && end.done()) {
        const auto word = static_cast<std::uint16_t>(canopen::low_first(end.data));
        if (!job.went) job.status = word;
        polled.saw_status(word);
        feedback.on_status_word(word, t);
    }
    if (s.kind == Step::Kind::until && end.done() && still_waits(job, s, end, t)) return News::none;
    job.give_up = never;
    job.wait_until = {};
    const bool taken = s.edge && !std::holds_alternative<Move>(job.command.body);  // values that the drive shows before it has seen the
                                                                                   // control word are old
    if (taken || s.seen) job.wait_until = t.now + seen_by_all;
    if (++job.at < job.steps.size()) {
        if (job.steps[job.at].edge && !job.released) job.wait_until = known.low_since + seen_by_all;
        return News::none;
    }
    Job done = std::move(job);
    drop(done);
    return finish(done, t);
}

/// The value is not the expected one, and the step has not ended: read it again, or let the job fail.
bool Axis::still_waits(Job& job, const Step& s, const canopen::SdoEnd& end, Turn& t) {
    if (s.away_from) {
        const std::int64_t at = signed_of(end.data), want = static_cast<std::int32_t>(s.want);
        if (std::llabs(at - want) <= std::llabs(at - *s.away_from)) return feedback.on_position(at, t), false;
    } else if (met(known, job, s, end, t.now)) {
        return false;
    }
    if (plan_anew(node, known, place_, job, s, static_cast<unsigned>(canopen::low_first(end.data)), t.now)) return true;
    if (job.give_up == never) job.give_up = t.now + s.patience;
    job.wait_until = t.now + std::chrono::milliseconds(10);
    if (t.now < job.give_up) return true;
    if (s.optional) return false;
    if (s.awaits == Step::Awaits::mode && !std::exchange(job.mode_again, true)) {  // some drives drop the order silently while they move
        job.give_up = never;
        job.wait_until = {};
        --job.at;  // the write of 6060h
        return true;
    }
    if (s.awaits == Step::Awaits::acknowledge && has_begun(known, job)) {
        known.no_acknowledge = true;
        return unacknowledged(job), false;
    }
    std::string text = not_met(known, s, end);
    if (job.stream) {
        t.out.stream_ends.push_back({id_, Reason::drive_refused, text});
        stream.end();
    }
    node.tickets.failed(job.command.ticket, Reason::drive_refused, std::move(text), t.out);
    const bool started = job.went.has_value();
    drop(job);
    // An order that is answered as failed must not be carried out later.
    if (started) take_back(Halt{}, nullptr);
    if (s.awaits == Step::Awaits::mode) take_back(Halt{}, plan_mode_back);
    return true;
}

void Axis::saw_status(unsigned sw) noexcept {
    if (job_ && job_->went && (sw & 0x1000u) == 0) job_->begun = true;
}

/// The drive has acknowledged the order of a motion.
void Axis::moves_now(const CommandBody& body, std::int64_t here, Turn& t) {
    if (const auto* m = std::get_if<Move>(&body)) {
        const Order order = m->kind == Move::Kind::velocity ? Order::velocity : Order::position;
        if (m->velocity && order == Order::position) known.rates[0] = *m->velocity;
        if (m->acceleration) known.rates[1] = *m->acceleration;
        if (m->deceleration) known.rates[2] = *m->deceleration;
        std::optional<std::int64_t> target;
        if (order == Order::position) target = m->kind == Move::Kind::relative ? saturated_sum(m->target, here) : m->target;
        feedback.ordered(order, target, t);
    }
    if (std::holds_alternative<Home>(body)) feedback.ordered(Order::homing, {}, t);
    if (std::holds_alternative<SetPosition>(body)) {
        known.fb.referenced = true;
        known.target.reset();  // it was a number of before
        known.at_target = false;
    }
    if (const auto* home = std::get_if<Home>(&body); home && home->method != 0) known.homing_method = home->method;
}

Axis::News Axis::finish(Job& job, Turn& t) {
    const CommandBody& body = job.command.body;
    if (known.profile) feedback.look_soon(t.now + std::max<Duration>(3 * node.line.cycle(), std::chrono::milliseconds(150)));
    if (job.stream) {
        stream.begun(job.here);
        return News::none;
    }
    if (is_urgent(body)) {
        known.order = Order::none;
        known.fb.homing = false;
    }
    moves_now(body, job.here, t);
    const auto* read = std::get_if<ReadParameter>(&body);
    const auto* to = std::get_if<WriteParameter>(&body);
    Value value;
    std::string text;
    if (read && !read_value(job, *read, value, t)) return News::none;
    if (to) {
        value = to->value;
        written(*to);
    }
    if (std::holds_alternative<Native>(body)) text = native_text(job);
    if (!job.text.empty()) text = job.text;
    if (read || to) t.out.samples.push_back({id_, read ? read->point : to->point, value, Quality::good, t.now, 0});
    const auto* action = std::get_if<Action>(&body);
    if (action && action->name == "store_parameters") text = node.stored(t);
    node.tickets.answer(job.command.ticket, read || to ? Outcome::done : Outcome::accepted, Reason::none, std::move(text), t.out, 0,
                        std::move(value), job.data);
    return action && action->name == "nmt_reset_node" ? News::node_resets : News::none;
}

bool Axis::read_value(const Job& job, const ReadParameter& read, Value& value, Turn& t) {
    const Parameter* p = node.catalogue().parameter(read.point);
    const auto type = p ? type_of(p->type) : std::nullopt;
    value = type ? canopen::decode(*type, job.data).value_or(Value{}) : Value{};
    if (!axisgate::known(value)) {
        node.tickets.failed(job.command.ticket, Reason::drive_refused,
                            fmt::format("{}: the drive gives {} bytes, which are none of its type", p ? p->id : "?", job.data.size()),
                            t.out);
        return false;
    }
    if (p->type == ValueType::boolean) value = Value{as_integer(value).value_or(0) != 0};
    return true;
}

/// Objects whose values the gateway uses itself.
void Axis::written(const WriteParameter& to) {
    const Parameter* p = node.catalogue().parameter(to.point);
    const auto place = p ? place_of(*p, to.point) : std::nullopt;
    const auto n = as_integer(to.value);
    if (!place || !n) return;
    if (*place == object::homing_method) known.homing_method = *n;
    for (const auto& [a, i] :
         {std::pair{object::profile_velocity, 0u}, {object::profile_acceleration, 1u}, {object::profile_deceleration, 2u}})
        if (*place == a) known.rates[i] = *n;
}

std::string Axis::native_text(const Job& job) const {
    const Step& last = job.steps.back();
    if (last.kind == Step::Kind::write) return "written";
    const Parameter* p = parameter_at(node.catalogue(), last.address);
    const auto type = p ? type_of(p->type) : std::nullopt;
    if (const auto decoded = type ? canopen::decode(*type, job.data) : std::nullopt) return to_text(*decoded);
    return fmt::format("{:02X}", fmt::join(job.data, " "));
}

}  // namespace axisgate::cia402_drive
