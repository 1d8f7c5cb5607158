// Stops: each from its frame to its acknowledgement, and the ramp behind it to standstill.
// In: stops, answers, refusals, silences, time. Out: urgent frames, results, what follows for motion and demand.
// Never waits for a place on the line; a halt by JV=0 alone waits for the exchange that it could overtake.
#include "adapters/uim342/stop.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
constexpr Duration look_again = std::chrono::milliseconds(100);

bool sets_motion(const Request* r) {
    if (!r) return false;
    const std::uint8_t f = r->message.function();
    return f == cw::BG || (form_of(r->message) == Form::set && (f == cw::PA || f == cw::PR || f == cw::JV || f == cw::SP));
}
}  // namespace

void Stops::add(const Command& command, Turn& t) {
    Stop s;
    if (std::holds_alternative<Disable>(command.body)) s.kind = Stop::Kind::off;
    if (std::holds_alternative<Halt>(command.body)) s.kind = Stop::Kind::halt;
    s.ticket = command.ticket;
    interrupt(name_of(command.body), s.kind != Stop::Kind::halt, t);
    add(s, t);
}

void Stops::interrupt(std::string_view by, bool power_off, Turn& t) {
    drive_.break_off(Reason::interrupted, drive::CommandQueue::interrupted_by(by), t);
    const auto ends = [&](const Command& c) { return drive::is_motion(c.body) || (power_off && std::holds_alternative<Enable>(c.body)); };
    drive_.jobs.interrupt(ends, by, t);
}

const CommandBody* Stops::locking() const noexcept {
    static const CommandBody quick{QuickStop{}}, off{Disable{}};
    const CommandBody* which = nullptr;
    lane_.each([&](const Stop& s) {
        if (s.kind != Stop::Kind::halt && !s.by_supervision) which = s.kind == Stop::Kind::off ? &off : &quick;
    });
    return which;
}

void Stops::add_shared(Turn& t) {
    interrupt("global_stop", true, t);
    Stop s;
    s.shared = true;
    add(s, t);
}

void Stops::enforce(Turn& t) {
    Stop s;
    s.by_supervision = true;
    add(s, t);
}

void Stops::add(const Stop& wanted, Turn& t) {
    if (Stop* s = lane_.add(wanted)) return begin(*s, t);
    // All places are taken by stops that nobody has acknowledged: this one is sent too, but cannot be watched.
    Message m = wanted.kind == Stop::Kind::off ? drive_.set(cw::MO, 0) : drive_.act(cw::ST);
    m.cw &= static_cast<std::uint8_t>(~ack_bit);
    drive_.bus.transmit(m, Priority::urgent, t, wanted.ticket);
    drive_.demand.forget();
    const std::string text = fmt::format("sent, but not watched: {} stops wait for their acknowledgement already", limit);
    (void)drive_.tickets.failed(wanted.ticket, Reason::busy, text, t.out);
    if (wanted.shared) drive_.bus.share_done(drive_, {false, Reason::busy, 0, text}, t);
}

void Stops::begin(Stop& s, Turn& t) {
    const int retries = drive_.bus.timing.retries;
    const Request* on_its_way = drive_.exchanges.on_its_way();
    const bool group_start = drive_.together.on_its_way(t.now);
    drive_.jobs.disturbed();
    if (s.kind == Stop::Kind::off) {
        const bool turns_on =
            drive_.exchanges.on_its_way(cw::MO) && form_of(on_its_way->message) == Form::set && on_its_way->message.d[0] != 0;
        if (turns_on) repeat_ = Stop::Kind::off;
        return send(s, drive_.set(cw::MO, 0), retries, t);
    }
    if (s.kind == Stop::Kind::halt && drive_.presence.is(drive::Presence::Phase::ready)) {
        // There is no instruction "stop on DC". A jog speed of 0 and BG decelerate with DC; ST would use SD. With AC and DC as
        // times the ramp to speed 0 is not defined, and at rest there is nothing to decelerate: then ST.
        // With a group of MF perhaps still selected JV could go astray: then ST too.
        const bool defined = drive_.known.ram.time_ramps == false && !group_start && !drive_.exchanges.mf_unknown;
        if (defined && sets_motion(on_its_way)) {
            // JV=0 could overtake a PA that BG would then start: after the exchange in progress, which is not repeated any more.
            s.soft = s.waiting = true;
            return drive_.exchanges.no_repeats();
        }
        if (defined && drive_.feedback.fb().moving && !ramp_) {  // during an SD ramp BG is refused (0x3F)
            s.soft = true;
            s.begun = false;
            return send(s, drive_.set(cw::JV, 0), 0, t);
        }
    }
    s.soft = false;
    if (group_start || drive_.exchanges.on_its_way(cw::BG)) repeat_ = Stop::Kind::quick;
    send(s, drive_.act(cw::ST), retries, t);
}

void Stops::exchange_ended(Turn& t) {
    lane_.each([&](Stop& s) {
        if (!s.waiting || sets_motion(drive_.exchanges.on_its_way())) return;
        s.waiting = false;
        begin(s, t);
    });
}

void Stops::send(Stop& s, const Message& m, int retries, Turn& t) {
    s.exchange.begin(m, t.now, drive_.bus.timing.reply_timeout, retries);
    drive_.bus.transmit(m, Priority::urgent, t, s.ticket);
}

void Stops::repeat(Turn& t) {
    const Message m = std::exchange(repeat_, {}) == Stop::Kind::off ? drive_.set(cw::MO, 0) : drive_.act(cw::ST);
    drive_.exchanges.send({m, Purpose::confirm}, drive_.bus.timing.retries, Priority::command, t);
}

void Stops::answered(Stop& s, const Message& m, Turn& t) {
    drive_.feedback.learn(s.exchange.request(), m, 0, true, t);
    if (s.kind == Stop::Kind::off) {
        if (m.dl > 0 && m.d[0] != 0)
            return over(s, Outcome::failed, Reason::drive_refused, "the drive acknowledged MO=0 with MO = 1: it is still on", 0, t);
        drive_.feedback.no_motion();
        drive_.demand.forget();
        drive_.polls.soon(t.now);
        return over(s, Outcome::accepted, Reason::none, "", 0, t);
    }
    if (s.soft && !s.begun) {
        s.begun = true;
        return send(s, drive_.act(cw::BG), 0, t);
    }
    drive_.demand.stops(s.soft, t.now);
    drive_.feedback.no_goal();
    if (s.soft) {
        drive_.feedback.slows_down(t.now);
    } else if (s.kind == Stop::Kind::quick) {
        ramp_ = !drive_.feedback.status().stop;
    }
    if (!s.by_supervision) supervise(s.soft, t);
    drive_.feedback.update(t);
    drive_.polls.soon(t.now);
    over(s, Outcome::accepted, Reason::none, "", 0, t);
}

void Stops::refused(Stop& s, const Message& m, Turn& t) {
    const auto report = error_report_of(m);
    const std::uint8_t code = report ? report->code : std::uint8_t{0};
    const std::string request = describe_request(s.exchange.request()), error = describe_error(code);
    if (s.soft) return harden(s, fmt::format("{} was refused ({})", request, error), t);
    over(s, Outcome::refused, Reason::drive_refused, fmt::format("{}: the drive says {}", request, error), code, t);
}

void Stops::silent(Stop& s, Turn& t) {
    const std::string request = describe_request(s.exchange.request());
    drive_.exchanges.given_up(s.exchange.request());
    drive_.demand.forget();
    if (s.soft) {
        if (s.begun) repeat_ = Stop::Kind::quick;  // its BG may still come
        return harden(s, request + " was not acknowledged", t);
    }
    over(s, Outcome::failed, Reason::no_answer,
         fmt::format("{} was sent {} times and not acknowledged: whether the axis stops is not known", request, s.exchange.tries()), 0, t);
    drive_.polls.soon(t.now);
    drive_.exchanges.count_silence(t);
}

/// The way by DC did not work: ST.
void Stops::harden(Stop& s, std::string_view why, Turn& t) {
    drive_.notice(Severity::warning, "stop", 0, fmt::format("halt: {}; ST is sent instead", why), t);
    s.soft = false;
    send(s, drive_.act(cw::ST), drive_.bus.timing.retries, t);
}

void Stops::over(Stop& s, Outcome outcome, Reason reason, std::string text, std::int32_t code, Turn& t) {
    const Stop was = s;
    lane_.remove(&s);
    const bool good = outcome == Outcome::accepted;
    if (was.shared) drive_.bus.share_done(drive_, {good, reason, code, text}, t);
    (void)drive_.tickets.answer(was.ticket, outcome, reason, std::move(text), t.out, code);
}

void Stops::fail_all(Reason reason, const std::string& text, Turn& t) {
    lane_.each([&](Stop& s) { over(s, Outcome::failed, reason, text, 0, t); });
    repeat_.reset();
    supervise_at_ = never;
}

// --- the ramp behind it ----------------------------------------------------------------------------------------------------------

/// The axis must stand within half as long again as its ramp takes, and 300 ms.
void Stops::supervise(bool soft, Turn& t) {
    const auto& rate = soft ? drive_.known.ram.dc : drive_.known.ram.sd;
    double ramp_s = 2.0;
    if (rate && *rate > 0) ramp_s = static_cast<double>(std::llabs(drive_.feedback.fb().velocity)) / static_cast<double>(*rate);
    if (!soft && rate == 0u) ramp_s = 0;
    ramp_s = std::min(ramp_s * 1.5 + 0.3, 60.0);
    supervise_at_ = t.now + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(ramp_s));
    acknowledged_at_ = t.now;
    doubt_until_ = supervise_at_ + status_doubt;
    supervise_soft_ = soft;
}

Instant Stops::deadline() const noexcept {
    Instant due = supervise_at_;
    lane_.each([&](const Stop& s) { due = std::min(due, s.exchange.deadline()); });
    return due;
}

void Stops::on_deadline(Turn& t) {
    lane_.each([&](Stop& s) {
        const drive::Late late = s.exchange.on_deadline(t.now, drive_.bus.counters);
        if (late == drive::Late::repeat) drive_.bus.transmit(s.exchange.request(), Priority::urgent, t, s.ticket);
        if (late == drive::Late::over) silent(s, t);
    });
    if (t.now >= supervise_at_) look(t);
}

/// The status of a drive can be later than the speed, which is measured: an axis with a speed of 0 behind its stop stands, and another ST
/// would end the motion that is being begun meanwhile. A status that does not change is not believed to be late for ever.
void Stops::look(Turn& t) {
    supervise_at_ = never;
    const Feedback& feedback = drive_.feedback;
    const AxisFeedback& fb = feedback.fb();
    if (!fb.moving || !drive_.presence.online()) return;
    if (fb.velocity == 0 && feedback.position_at() > acknowledged_at_ && t.now < doubt_until_) {
        supervise_at_ = std::min(t.now + look_again, doubt_until_);
        return;
    }
    drive_.notice(
        Severity::warning, "stop", 0,
        fmt::format("the axis still moves after {}, at {} pulse/s; ST is sent", supervise_soft_ ? "a halt" : "a stop", fb.velocity), t);
    enforce(t);
}

}  // namespace axisgate::uim342
