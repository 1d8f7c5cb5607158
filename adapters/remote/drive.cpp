// Only one request for the state is outstanding at a time.
#include "adapters/remote/drive.hpp"

#include <algorithm>

#include "gateway/drive/text_lines.hpp"

namespace axisgate::remote {
using mirror::Telegram;
using Phase = Presence::Phase;
using namespace std::chrono_literals;

void Line::take(const LineSetup& setup, Instant now) {
    Bus::take(setup, {.reply_timeout = 300ms, .poll_period = 50ms});
    stale_after = setup.timing.stale_after > Duration::zero() ? setup.timing.stale_after : Duration(3s);
    if (next == 0) next = static_cast<std::uint64_t>(std::max<std::int64_t>(1, now.time_since_epoch() / 1ms));
}

Drive::Drive(Line& line, const DriveSetup& setup) : line_(line), setup_(setup), presence_(setup.id, line.timing) {
    answer_time_ = std::chrono::milliseconds(std::atoi(option(setup.options, "answer_ms", "5000").c_str()));
}

void Drive::line_down(std::string_view why, Turn& t) {
    remove(why, t);
    presence_.report(std::string(why), t.out);
}

void Drive::remove(std::string_view why, Turn& t) {
    presence_.close();
    poll_.drop();
    timer_.stop();
    stops_.clear();
    queue_.clear();
    running_.reset();
    renewal_.reset();
    asked_.reset();
    tickets_.fail_all(Reason::line_down, why, t.out);
}

void Drive::submit(const Command& c, Turn& t) {
    if (drive::admit(c, setup_.name, presence_, queue_, tickets_, t) != drive::Admission::urgent) return;
    const auto ends = [&](const Command& w) { return drive::ended_by(c.body, w.body); };
    (void)queue_.interrupt(ends, name_of(c.body), tickets_, t);
    if (running_ && ends(running_->command)) {
        tickets_.failed(running_->command.ticket, Reason::interrupted, drive::CommandQueue::interrupted_by(name_of(c.body)), t.out);
        running_.reset();
    }
    renewal_.reset();
    asked_.reset();
    mirror::Order order;
    order.verb = name_of(c.body);
    order.wait_ms = milliseconds_of(answer_time_);
    if (!stops_.add({c.ticket, 0, std::move(order), t.now, 1 + line_.timing.retries}))
        tickets_.refused(c.ticket, Reason::busy, "8 stops are on their way already", t.out);
}

std::uint64_t Drive::send(const mirror::Order& order, Priority priority, Turn& t, std::uint64_t number) {
    if (number == 0) number = line_.next++;
    std::string text = mirror::text_of({Telegram::Kind::request, number, setup_.address, body_of(order)});
    // A stop may interrupt another telegram, which ends with the line break: the stop is a line of its own.
    if (priority == Priority::urgent) text.insert(0, "\n");
    for_each_run(drive::bytes_of(text), [&](const Frame& f) { t.out.send(f, priority); });
    return number;
}

void Drive::ask(Turn& t) {
    mirror::Order state;
    state.verb = "state";
    poll_.begin(send(state, Priority::poll, t), t.now, line_.timing.reply_timeout, 0);
    timer_.asked(t.now, pace_.period(line_.timing.poll_period, axis_.moving));
}

void Drive::go(Turn& t) {
    if (presence_.is(Phase::down)) return;
    stops_.each([&](Stop& s) {
        if (s.left == 0 || t.now < s.again) return;
        --s.left;
        s.again = t.now + line_.timing.reply_timeout;
        s.number = send(s.order, Priority::urgent, t, s.number);
        newest_ = std::max(newest_, s.number);
    });
    if (!presence_.online()) {
        if (!presence_.probe_due(t.now) || poll_.active()) return;
        presence_.probe_sent();
        return ask(t);
    }
    while (!running_ && !queue_.empty())
        begin(queue_.pop(), t);
    for (auto* r : {&renewal_, &asked_}) {
        if (!*r || t.now < (*r)->next) continue;
        (*r)->number = send((*r)->order, Priority::command, t);
        (*r)->next = t.now + renewed;
    }
    if (!poll_.active() && timer_.due(t.now)) ask(t);
}

Instant Drive::deadline() const noexcept {
    if (presence_.is(Phase::down)) return never;
    Instant first = std::min(poll_.deadline(), running_ ? running_->until : never);
    stops_.each([&](const Stop& s) { first = std::min(first, s.again); });
    if (!poll_.active()) first = std::min(first, presence_.online() ? timer_.deadline() : presence_.deadline());
    for (const auto* r : {&renewal_, &asked_})
        if (*r) first = std::min(first, (*r)->next);
    return first;
}

void Drive::on_deadline(Turn& t) {
    stops_.each([&](Stop& s) {
        if (t.now < s.again) return;
        if (s.number != 0) ++line_.counters.timeouts;
        if (s.left > 0) return void(line_.counters.retries += s.number != 0 ? 1 : 0);  // go() sends it
        tickets_.failed(s.ticket, Reason::no_answer, s.order.verb + " was not answered: whether it was carried out is not known", t.out);
        stops_.remove(&s);
    });
    if (running_ && t.now >= running_->until) {
        ++line_.counters.timeouts;
        tickets_.failed(running_->command.ticket, Reason::no_answer,
                        "the gateway of " + setup_.address + " did not answer in time: whether the command was carried out is not known",
                        t.out);
        running_.reset();
        asked_.reset();
    }
    if (poll_.on_deadline(t.now, line_.counters) == drive::Late::over) asked_in_vain("the mirror line does not answer", false, t);
}

/// A request for the state was not answered, or the answer was that the axis does not exist.
void Drive::asked_in_vain(std::string_view why, bool gone, Turn& t) {
    const bool was_online = presence_.online();
    if (gone && !presence_.is(Phase::absent)) {
        presence_.lose(t.now);
    } else if (presence_.silent(t.now) == Presence::Silence::counted) {
        if (was_online) timer_.soon(t.now);
        return;
    }
    lost(std::string(why), t);
}

void Drive::lost(const std::string& why, Turn& t) {
    poll_.drop();
    timer_.stop();
    queue_.clear();
    running_.reset();
    renewal_.reset();
    asked_.reset();
    // Stops without an answer are still repeated: a gateway that does not answer may still receive them.
    tickets_.fail_all(Reason::no_answer, why, t.out);
    presence_.report(why, t.out);
}

void Drive::on_telegram(const Telegram& telegram, Turn& t) {
    const bool polled = poll_.active() && poll_.request() == telegram.number;
    const bool ran = running_ && running_->number == telegram.number;
    if (telegram.kind == Telegram::Kind::answer) {
        const auto answer = mirror::answer_of(telegram.body);
        if (!answer) return void(++line_.counters.garbled);
        Stop* stop = nullptr;
        stops_.each([&](Stop& s) {
            if (s.number == telegram.number) stop = &s;
        });
        if (stop) {
            ++line_.counters.exchanges;
            tickets_.answer(stop->ticket, answer->outcome, answer->reason, answer->text, t.out, answer->code);
            stops_.remove(stop);
            if (presence_.online()) timer_.soon(t.now);
        } else if (ran) {
            ++line_.counters.exchanges;
            answered(*answer, t);
        } else if (renewal_ && renewal_->number == telegram.number) {
            // The motion has ended at the other gateway: there is nothing to renew. While it decides about another one, it refuses both.
            if (!asked_ && answer->outcome != Outcome::accepted && answer->outcome != Outcome::done && answer->reason != Reason::busy)
                renewal_.reset();
        } else if (telegram.number >= line_.next || telegram.number == 0) {
            ++line_.counters.unexpected;
        }
        return;
    }
    if (telegram.number != 0 && !polled && !ran) return void(++line_.counters.unexpected);
    if (polled) (void)poll_.answered(line_.counters);
    if (telegram.kind == Telegram::Kind::gone) {
        if (polled || presence_.online()) asked_in_vain(telegram.body, true, t);
        return;
    }
    const auto state = mirror::state_of(telegram.body);
    if (!state) return void(++line_.counters.garbled);
    if (!presence_.online()) {
        if (!polled) return presence_.received(t.now);
        presence_.found();
        presence_.made_ready();
        presence_.report(setup_.address + (state->simulated ? ", simulated there" : ", by its gateway"), t.out);
        timer_.soon(t.now + line_.timing.poll_period);
    }
    presence_.answered();
    // This state was requested before the axis was ordered to move or stop, so it is too old.
    if (polled && telegram.number < newest_) return timer_.soon(t.now);
    learn(*state, t);
    if (ran) finish({Outcome::accepted, Reason::none, 0, {}}, t);
}

void Drive::learn(const mirror::State& s, Turn& t) {
    const unsigned power = s.statusword & 0x6Fu;
    AxisFeedback& fb = axis_;
    const bool homing_mode = s.mode == 6;
    const bool on = power == 0x27 || power == 0x07 || (s.statusword & 0x4Fu) == 0x0F;
    fb.power = on ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    fb.statusword = s.statusword;
    fb.quick_stopping = power == 0x07;
    // The age is that at the other gateway: feedback that is stale there is never fresh here.
    const Duration age = std::max(Duration(std::chrono::milliseconds(std::min<std::int64_t>(s.age_ms, 86'400'000))),
                                  s.stale ? line_.stale_after + 1ms : Duration::zero());
    // A state from before the motion knows the end of the one before. Ages are whole milliseconds.
    const bool older = on && !s.fault && t.now - age - 1ms < begun_;
    fb.moving = s.moving || older;
    fb.target_reached = s.target_reached && !fb.moving;
    fb.referenced = s.referenced;
    fb.fault = s.fault;
    fb.warning = s.warning;
    fb.internal_limit = (s.statusword & 0x0800u) != 0;
    fb.homing = homing_mode && !(s.statusword & 0x0400u);
    fb.homing_attained = homing_mode && (s.statusword & 0x1000u);
    fb.homing_error = homing_mode && (s.statusword & 0x2000u);
    fb.position = s.position;
    fb.position_demand = s.demand;
    fb.demand_source = s.demand_source;
    fb.velocity = s.velocity;
    fb.error_code = s.error_code;
    fb.native_status = s.statusword;
    // By the mode that the other gateway shows; the mirror has no rates and inputs of the drive.
    fb.course = s.mode == 1 ? Course::to_target : s.mode == 3 || (s.mode >= 8 && s.mode <= 10) ? Course::endless : Course::unknown;
    fb.simulated = s.simulated;
    fb.at = std::max(time_zero + 1ns, t.now - age);
    if (!fb.moving || s.fault) {
        if (renewal_ && renewal_->number != 0) renewal_.reset();
    }
    timer_.soon(std::min(timer_.deadline(), t.now + pace_.period(line_.timing.poll_period, fb.moving)));
    emit(t);
}

void Drive::emit(Turn& t) {
    for (const AxisSetup& a : setup_.axes)
        t.out.feedback.push_back({a.id, axis_});
}

}  // namespace axisgate::remote
