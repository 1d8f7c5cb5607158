// Exchanges: sending, matching, time-outs, repeats, late answers.
// In: messages of this drive, time. Out: what each answer, refusal or silence means for the part that asked.
// Never repeats what must not be sent twice: whoever asks says how often.
#include "adapters/uim342/drive_exchange.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "adapters/uim342/drive.hpp"
#include "gateway/core/only_reads.hpp"

namespace axisgate::uim342 {

Ticket Exchanges::order_of(const Request& request) const noexcept {
    return request.purpose == Purpose::job ? drive_.jobs.job().command.ticket : no_ticket;
}

void Exchanges::send(const Request& request, int retries, Priority priority, Turn& t) {
    exchange_.begin(request, t.now, drive_.bus.timing.reply_timeout, retries);
    drive_.bus.turns.began(drive_.slot(), request.purpose == Purpose::probe);
    drive_.bus.transmit(request.message, priority, t, order_of(request));
}

bool Exchanges::makes_way(const Message& m, std::uint8_t mf, Priority priority, Turn& t) {
    const Instruction* i = instruction(m.cw);
    if (late(m)) {
        barrier(t);
    } else if (mf_unknown && mf == 0 && i && i->takes_mf && !only_reads(drive_.setup().options)) {
        send({drive_.set(cw::MF, 0), Purpose::clear_mf}, drive_.bus.timing.retries, priority, t);
    } else {
        return false;
    }
    return true;
}

/// A read that has nothing to do with the late answers: when it is answered, they can only have come before it.
void Exchanges::barrier(Turn& t) {
    const std::array candidates{drive_.get(cw::MS, 1), drive_.get(cw::MO), drive_.get(cw::DV, 0), drive_.get(cw::DI), drive_.get(cw::MS)};
    const auto free = std::ranges::find_if(candidates, [&](const Message& c) { return !late(c); });
    send({free != candidates.end() ? *free : candidates.front(), Purpose::barrier}, 0, Priority::poll, t);
}

void Exchanges::abandon_job() noexcept {
    if (!exchange_.active() || exchange_.request().purpose != Purpose::job) return;
    exchange_.request().purpose = Purpose::orphan;
    exchange_.no_repeats();
}

void Exchanges::drop() noexcept {
    exchange_.drop();
    drive_.bus.turns.ended(drive_.slot());
}

void Exchanges::on_message(const Message& m, Turn& t) {
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
        if (!same && late(request)) return;  // the answer of one that was given up
        if (!best.found || (same && !best.same) || (same == best.same && sent < best.sent)) best = {true, same, how, stop, sent};
    };
    if (exchange_.active()) consider(nullptr, exchange_.request().message, exchange_.sent());
    drive_.stops.each([&](Stop& s) {
        if (s.exchange.active()) consider(&s, s.exchange.request(), s.exchange.sent());
    });
    if (!best.found) {
        if (!torn && m.cw == cw::ER) {
            drive_.errors.on_report(m, t);
        } else {
            ++(torn ? drive_.bus.counters.garbled : drive_.bus.counters.unexpected);
        }
        return drive_.presence.received(t.now);  // an absent drive that says anything is asked at once
    }
    drive_.presence.answered();
    late_.clear();
    // The other copies' answers may still come.
    if (best.stop && best.stop->exchange.tries() > 1) given_up(best.stop->exchange.request());
    if (!best.stop && exchange_.tries() > 1) given_up(exchange_.request().message);
    const bool no = best.how == Match::error;
    if (no) {
        ++drive_.bus.counters.refused;
        drive_.errors.refused_ours(m);
    }
    if (best.stop) {
        (void)best.stop->exchange.answered(drive_.bus.counters);
        return no ? drive_.stops.refused(*best.stop, m, t) : drive_.stops.answered(*best.stop, m, t);
    }
    no ? refused(m, t) : answered(m, t);
}

Request Exchanges::ended() {
    drive_.bus.turns.ended(drive_.slot());
    return exchange_.answered(drive_.bus.counters);
}

void Exchanges::answered(const Message& m, Turn& t) {
    const Instant sent = exchange_.sent();
    const Request e = ended();
    if (e.purpose == Purpose::probe) return drive_.start.probe_answered(m, t);
    if (e.purpose == Purpose::error) {
        drive_.errors.on_latest(m, t);
    } else {
        drive_.feedback.learn(e.message, m, e.mf, e.purpose != Purpose::poll, t);
    }
    if (m.cw == cw::MS && m.d[0] == 0) drive_.together.at_status(sent, t);
    if (e.purpose == Purpose::startup) drive_.start.step_done(t);
    if (e.purpose == Purpose::clear_mf) mf_unknown = false;
    if (e.purpose == Purpose::job) drive_.jobs.answered(m, t);
    // The motion of a job that a stop has ended: it may have begun, and the stop is repeated behind it.
    if (e.purpose == Purpose::orphan && e.message.function() == cw::BG) drive_.feedback.begin_motion({Motion::Kind::unknown}, t);
    drive_.stops.exchange_ended(t);
}

void Exchanges::refused(const Message& m, Turn& t) {
    const Request e = ended();
    if (e.mf != 0 || e.message.function() == cw::MF) mf_unknown = true;
    if (e.purpose == Purpose::clear_mf) mf_unknown = false;
    if (e.purpose == Purpose::probe) drive_.start.probe_refused(t);
    if (e.purpose == Purpose::startup) drive_.start.step_done(t);  // this firmware does not have it: the value stays unknown
    if (e.purpose == Purpose::job) drive_.jobs.refused(m, t);
    drive_.stops.exchange_ended(t);
}

/// The present exchange got no answer, however often it was sent.
void Exchanges::silent(Turn& t) {
    drive_.bus.turns.ended(drive_.slot());
    const Request e = exchange_.request();
    given_up(e.message);
    if (e.mf != 0 || e.message.function() == cw::MF) mf_unknown = true;
    if (e.purpose == Purpose::startup) drive_.start.step_silent();
    if (e.purpose == Purpose::job) drive_.jobs.silent(t);
    if (e.purpose == Purpose::error) drive_.errors.read_again();
    if (e.mf == 0 && Known::changes_rates(e.message)) drive_.start.read_again();
    if (e.purpose == Purpose::confirm) drive_.notice(Severity::warning, "stop", 0, "a repeated stop was not acknowledged", t);
    if (e.purpose == Purpose::confirm || e.purpose == Purpose::orphan) drive_.polls.soon(t.now);
    count_silence(t);
    if (!drive_.presence.is(drive::Presence::Phase::absent)) drive_.stops.exchange_ended(t);
}

void Exchanges::count_silence(Turn& t) {
    using Silence = drive::Presence::Silence;
    drive::Presence& presence = drive_.presence;
    const Duration before = presence.retry_pause();
    const Silence s = presence.silent(t.now);
    if (s == Silence::lost)
        drive_.start.lost(t, fmt::format("ID {} has not answered {} times in a row", drive_.address(), presence.silences()));
    if (s == Silence::still_absent && presence.retry_pause() != before)
        presence.report(fmt::format("ID {} does not answer", drive_.address()), t.out);
}

void Exchanges::on_deadline(Turn& t) {
    const drive::Late late = exchange_.on_deadline(t.now, drive_.bus.counters);
    if (late == drive::Late::repeat) drive_.bus.transmit(exchange_.request().message, Priority::command, t, order_of(exchange_.request()));
    if (late == drive::Late::over) silent(t);
}

}  // namespace axisgate::uim342
