// Drive: its exchanges: sending, matching, time-outs, repeats, late answers, and the choice of what is sent next.
// In: messages of this drive and the passing of time. Out: the answer to whoever asked, or the news that there is none.
// Never takes a late answer for a new one: an instruction with the same mark waits behind another exchange (LateMarks).
#include "adapters/uim342/drive.hpp"

#include <fmt/core.h>

#include "adapters/uim342/native.hpp"
#include "gateway/drive/option_reader.hpp"

namespace axisgate::uim342 {

DriveOptions drive_options(const DriveSetup& setup) {
    drive::OptionReader read(setup.options);
    DriveOptions o;
    o.notify = read.flag("notify", false);
    o.absolute_known = read.word("referenced", {"session", "absolute"}) == "absolute";
    o.home_high = read.word("home_active", {"high", "low"}) == "high";
    o.home_input = static_cast<std::uint8_t>(read.whole("home_input", 1, 3, 0));
    o.home_velocity = static_cast<std::uint32_t>(read.whole("home_velocity", 1, 8'388'607, 0));
    o.home_timeout = std::chrono::seconds(read.whole("home_timeout_s", 1, 3600, 60));
    o.faults = read.take_faults();
    return o;
}

Drive::Drive(Bus& bus, const DriveSetup& setup, std::uint8_t address, std::size_t slot)
    : bus_(bus),
      setup_(setup),
      options_(drive_options(setup)),
      address_(address),
      slot_(slot),
      presence_(setup.id, bus.timing),
      notices_(setup.id) {
    for (const auto& a : setup.axes) {
        if (a.channel == 1) axis_ = a.id;
    }
    waits_.reserve(wait_limit);
}

// --- the line ----------------------------------------------------------------------------------------------------------------

void Drive::line_up(Turn& t) {
    for (const auto& fault : options_.faults)
        notice(Severity::warning, "setup", 0, fault, t);
    begin_probing(t);
}

void Drive::line_down(Turn& t, std::string_view why) {
    fail_all(Reason::line_down, std::string(why), t);
    const bool was_online = online();
    presence_.close();
    late_.clear();  // nothing of before comes through a line that was down
    poll_.stop();
    if (was_online) presence_.report(std::string(why), t.out);
}

void Drive::remove(Turn& t, std::string_view why) {
    fail_all(Reason::line_down, std::string(why), t);
    presence_.close();
}

void Drive::fail_all(Reason reason, const std::string& text, Turn& t) {
    exchange_.drop();
    bus_.turns.ended(slot_);
    stops_.each([&](Stop& s) { stop_finished(s, Outcome::failed, reason, text, 0, t); });
    if (searching()) search_over(false, reason, text, t);
    if (job_.active) job_over(Outcome::failed, reason, text, t);
    end_waits(false, reason, text, t);
    bool joined = false;
    while (!queue_.empty()) {
        const Command waiting = queue_.pop();
        joined = joined || is_place(waiting);
        (void)tickets_.failed(waiting.ticket, reason, text, t.out);
    }
    if (joined) bus_.part_done(*this, {false, reason, 0, text}, t);
    confirm_.reset();
    prepared_ = false;
    supervise_at_ = never;
}

// --- commands ------------------------------------------------------------------------------------------------------------------

void Drive::submit(const Command& command, Turn& t) {
    const std::string who = fmt::format("{} (ID {})", name(), address_);
    if (drive::admit(command, who, presence_, queue_, tickets_, t) == drive::Admission::urgent) submit_stop(command, t);
}

// --- what is sent next -----------------------------------------------------------------------------------------------------------

drive::Want Drive::wants(Instant now) const noexcept {
    if (exchange_.active()) return Want::nothing;
    switch (presence_.phase()) {
        case Phase::down:
            return Want::nothing;
        case Phase::probing:
        case Phase::absent:
        case Phase::restarting:
            return presence_.probe_due(now) ? Want::probe : Want::nothing;
        case Phase::starting:
            return Want::poll;
        case Phase::ready:
            break;
    }
    if (confirm_) return Want::command;
    if (reading_.core_pending() && !(job_.active && !job_.waiting)) return Want::poll;
    // Commands wait while a stop is on its way: nothing may get between JV=0 and its BG, or start what is being stopped.
    if (!stopping() && ((job_.active && !job_.waiting) || queue_ready() || restore_due() || (search_.check_due && !job_.active)))
        return Want::command;
    if (poll_speed_ || poll_.due(now) || read_error_ || reading_.pending()) return Want::poll;
    return Want::nothing;
}

Instant Drive::deadline() const noexcept {
    Instant due = std::min({supervise_at_, search_.give_up, exchange_.deadline()});
    stops_.each([&](const Stop& s) { due = std::min(due, s.exchange.deadline()); });
    return due;
}

Instant Drive::wish() const noexcept { return presence_.is(Phase::ready) ? poll_.deadline() : presence_.deadline(); }

void Drive::go(Turn& t) {
    if (exchange_.active()) return;
    switch (presence_.phase()) {
        case Phase::down:
            return;
        case Phase::restarting:
        case Phase::probing:
        case Phase::absent:
            presence_.probe_sent();
            return send_exchange(msg_get(cw::ML), Purpose::probe, 0, 0, Priority::poll, t);
        case Phase::starting:
            return startup_next(t);
        case Phase::ready:
            break;
    }
    if (confirm_) {
        const Message m = *confirm_ == StopKind::off ? msg_set(cw::MO, 0) : msg_act(cw::ST);
        confirm_.reset();
        return send_exchange(m, Purpose::confirm, 0, bus_.timing.retries, Priority::command, t);
    }
    const bool may_command = !stopping();
    if (may_command && job_.active && !job_.waiting) return run_job(t);
    if (reading_.core_pending()) return startup_next(t);
    // Commands go before polls, but a poll that is a whole period late goes between two commands: the picture stays alive. One poll; on a
    // line that cannot carry all of them every poll is late, and commands would never have their turn.
    const bool overdue = commanded_last_ && poll_.late(t.now, bus_.timing.poll_period);
    if (may_command && !job_.active && !overdue) {
        if (restore_due()) return plan_restore(t);
        if (search_.check_due) return search_check(t);
        while (!exchange_.active() && queue_ready()) {
            commanded_last_ = true;
            take_next(t);
        }
        if (exchange_.active() || job_.active) return;
    }
    if (read_error_) {
        const Message m = msg_get(cw::ER, 0);
        if (late_.has(mark_of(m))) return go_barrier(t);
        read_error_ = false;
        return send_exchange(m, Purpose::error, 0, 1, Priority::poll, t);
    }
    // The rest of the reading goes between polls; on a line that is too slow for all of them, in turn with them.
    const bool poll_due = poll_speed_ || poll_.due(t.now);
    if (reading_.pending() && (!poll_due || startup_turn_)) {
        startup_turn_ = false;
        return startup_next(t);
    }
    startup_turn_ = true;
    if (!poll_due) return;
    commanded_last_ = false;
    const Message m = msg_get(cw::MS, poll_speed_ ? 1 : 0);
    if (!poll_speed_) poll_.asked(t.now, pace_.period(bus_.timing.poll_period, moving_now()));
    poll_speed_ = !poll_speed_;
    if (late_.has(mark_of(m))) return go_barrier(t);
    send_exchange(m, Purpose::poll, 0, 0, Priority::poll, t);
}

void Drive::poll_now(Turn& t) noexcept {
    poll_.soon(t.now);
    poll_speed_ = false;
}

/// A read that has nothing to do with the late answers: when it is answered, they can only have come before it.
void Drive::go_barrier(Turn& t) {
    const std::array candidates{msg_get(cw::MS, 1), msg_get(cw::MO), msg_get(cw::DV, 0), msg_get(cw::DI), msg_get(cw::MS, 0)};
    const Message* m = &candidates.front();
    for (const Message& c : candidates) {
        if (!late_.has(mark_of(c))) {
            m = &c;
            break;
        }
    }
    send_exchange(*m, Purpose::barrier, 0, 0, Priority::poll, t);
}

// --- exchanges -------------------------------------------------------------------------------------------------------------------

void Drive::send_exchange(const Message& m, Purpose p, std::uint8_t mf, int retries, Priority priority, Turn& t) {
    exchange_.begin({m, p, mf}, t.now, bus_.timing.reply_timeout, retries);
    bus_.turns.began(slot_, p == Purpose::probe);
    bus_.transmit(m, priority, t);
}

/// It has got its answer.
Drive::Request Drive::end_exchange() {
    bus_.turns.ended(slot_);
    return exchange_.answered(bus_.counters);
}

/// The job that waits for this answer is over.
void Drive::abandon_job_exchange() noexcept {
    if (!exchange_.active() || exchange_.request().purpose != Purpose::job) return;
    exchange_.request().purpose = Purpose::orphan;
    exchange_.no_repeats();
}

void Drive::on_message(const Message& m, Turn& t) {
    if (presence_.is(Phase::down)) return;
    if (m.cw & ack_bit) {
        ++bus_.counters.garbled;  // nothing that a device sends has bit 7 set
        return;
    }
    if (presence_.is(Phase::restarting)) {
        ++bus_.counters.unexpected;  // said before it fell silent
        return;
    }
    if (m.cw == cw::RT) return on_notification(m, t);

    // Whose answer is it? Of several that it fits, the one whose value it repeats, then the one that was sent first.
    struct {
        bool found = false, same = false;
        Match how = Match::no;
        Stop* stop = nullptr;  // nullptr: the exchange
        Instant sent = never;
    } best;
    bool torn = false;
    const auto consider = [&](Stop* stop, const Message& request, Instant sent) {
        const Match how = match(request, m);
        torn = torn || how == Match::torn;
        if (how != Match::answer && how != Match::error) return;
        const bool same = how == Match::error || echoes(request, m);
        if (!same && late_.has(mark_of(request))) return;  // the answer of one that was given up
        if (!best.found || (same && !best.same) || (same == best.same && sent < best.sent)) best = {true, same, how, stop, sent};
    };
    if (exchange_.active()) consider(nullptr, exchange_.request().message, exchange_.sent());
    stops_.each([&](Stop& s) {
        if (s.exchange.active()) consider(&s, s.exchange.request(), s.exchange.sent());
    });
    if (!best.found) {
        if (torn) {
            ++bus_.counters.garbled;
        } else if (m.cw == cw::ER) {
            on_error_report(m, t);
        } else {
            ++bus_.counters.unexpected;
        }
        // An absent drive that says anything is asked at once.
        presence_.heard(t.now);
        return;
    }
    presence_.answered();
    late_.clear();
    // The other copies' answers may still come.
    if (best.stop && best.stop->exchange.tries() > 1) late_.add(mark_of(best.stop->exchange.request()));
    if (!best.stop && exchange_.tries() > 1) late_.add(mark_of(exchange_.request().message));
    const Match how = best.how;
    if (how == Match::error) {
        ++bus_.counters.refused;
        if (cause_ == Cause::none) cause_ = Cause::own;
        if (const auto report = error_report_of(m)) latest_error_ = report->code;
    }
    if (!best.stop) return how == Match::error ? exchange_refused(m, t) : exchange_answered(m, t);
    (void)best.stop->exchange.answered(bus_.counters);
    how == Match::error ? stop_refused(*best.stop, m, t) : stop_answered(*best.stop, m, t);
}

void Drive::exchange_answered(const Message& m, Turn& t) {
    const Instant sent = exchange_.sent();
    const Request e = end_exchange();
    if (e.purpose == Purpose::probe) return probe_answered(m, t);
    if (e.purpose == Purpose::error) {
        on_latest_error(m, t);
    } else {
        learn(e.message, m, e.mf, e.purpose != Purpose::poll, t);
    }
    if (part_pending_ && m.cw == cw::MS && m.d[0] == 0 && sent >= motion_.begun) {
        // Asked behind the joint BG: had the drive refused that, its report would have come before this.
        part_pending_ = false;
        broadcast_until_ = t.now;
        if (part_until_done_) {
            add_wait(WaitFor::part, no_ticket, motion_.target, t);
        } else {
            bus_.part_done(*this, {true, Reason::none, 0, {}}, t);
        }
    }
    switch (e.purpose) {
        case Purpose::startup:
            startup_step_done(t);
            break;
        case Purpose::clear_mf:
            mf_unknown_ = false;
            break;
        case Purpose::job:
            job_answered(m, t);
            break;
        case Purpose::orphan:
            // The motion of a job that a stop has ended: it may have begun, and the stop is repeated behind it.
            if (e.message.function() == cw::BG) begin_unknown_motion(t);
            break;
        case Purpose::probe:
        case Purpose::poll:
        case Purpose::error:
        case Purpose::barrier:
        case Purpose::confirm:
            break;
    }
    waiting_stops(t);
}

void Drive::exchange_refused(const Message& m, Turn& t) {
    const Request e = end_exchange();
    if (e.mf != 0 || e.message.function() == cw::MF) mf_unknown_ = true;
    switch (e.purpose) {
        case Purpose::probe:
            // Whoever refuses ML is no UIM342 as the manual has it, or not ready: what waits is answered now, and it is asked again.
            presence_.lose(t.now, bus_.timing.pause_max);
            went_absent(t, fmt::format("ID {} refuses to tell its model", address_));
            break;
        case Purpose::startup:
            startup_step_done(t);
            break;  // this firmware does not have it: the value stays unknown
        case Purpose::job:
            job_refused(m, t);
            break;
        case Purpose::clear_mf:
            mf_unknown_ = false;
            break;
        case Purpose::error:
        case Purpose::poll:
        case Purpose::barrier:
        case Purpose::confirm:
        case Purpose::orphan:
            break;
    }
    waiting_stops(t);
}

/// The present exchange got no answer, however often it was sent.
void Drive::exchange_silent(Turn& t) {
    bus_.turns.ended(slot_);
    const Request e = exchange_.request();
    late_.add(mark_of(e.message));
    if (e.mf != 0 || e.message.function() == cw::MF) mf_unknown_ = true;
    switch (e.purpose) {
        case Purpose::startup:
            reading_.silent();
            break;
        case Purpose::job:
            job_silent(t);
            break;
        case Purpose::error:
            read_error_ = true;
            break;
        case Purpose::confirm:
            notice(Severity::warning, "stop", 0, "a repeated stop was not acknowledged", t);
            poll_now(t);
            break;
        case Purpose::orphan:
            poll_now(t);
            break;
        case Purpose::clear_mf:
        case Purpose::probe:
        case Purpose::poll:
        case Purpose::barrier:
            break;
    }
    count_silence(t);
    if (!presence_.is(Phase::absent)) waiting_stops(t);
}

void Drive::count_silence(Turn& t) {
    const Duration before = presence_.retry_pause();
    switch (presence_.silent(t.now)) {
        case drive::Presence::Silence::counted:
            break;
        case drive::Presence::Silence::lost:
            went_absent(t, fmt::format("ID {} has not answered {} times in a row", address_, presence_.silences()));
            break;
        case drive::Presence::Silence::still_absent:
            if (presence_.retry_pause() != before) presence_.report(fmt::format("ID {} does not answer", address_), t.out);
            break;
    }
}

void Drive::on_deadline(Turn& t) {
    switch (exchange_.on_deadline(t.now, bus_.counters)) {
        case drive::Late::no:
            break;
        case drive::Late::repeat:
            bus_.transmit(exchange_.request().message, Priority::command, t);
            break;
        case drive::Late::over:
            exchange_silent(t);
            break;
    }
    stops_.each([&](Stop& s) {
        switch (s.exchange.on_deadline(t.now, bus_.counters)) {
            case drive::Late::no:
                break;
            case drive::Late::repeat:
                bus_.transmit(s.exchange.request(), Priority::urgent, t);
                break;
            case drive::Late::over:
                stop_silent(s, t);
                break;
        }
    });
    if (t.now >= supervise_at_) supervision_due(t);
    if (t.now >= search_.give_up) search_deadline(t);
}

// --- results and notices ---------------------------------------------------------------------------------------------------------

void Drive::result(Ticket ticket, Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code, Value value,
                   std::vector<std::uint8_t> bytes) {
    (void)tickets_.answer(ticket, outcome, reason, std::move(text), t.out, code, std::move(value), std::move(bytes));
}

void Drive::notice(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t) {
    notices_.tell(severity, axis_, kind, code, std::move(text), t.now, t.out);
}

}  // namespace axisgate::uim342
