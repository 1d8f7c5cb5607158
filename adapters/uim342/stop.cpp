// Drive, part stop: quick stop, halt and disable: sent at once, before everything that waits and beside the exchange in progress.
// In: the three urgent commands, a joint stop, supervision. Out: ST, MO=0, or JV=0 and BG, urgent; their results.
// Never lets a motion outlive a stop: what waits is ended as interrupted, and if a BG may still be on its way behind the stop
// (the line lets urgent frames overtake), the stop is repeated behind it.
#include <fmt/core.h>

#include <cstdlib>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
bool sets_motion(const Message& m) {
    const std::uint8_t f = m.function();
    return f == cw::BG || (form_of(m) == Form::set && (f == cw::PA || f == cw::PR || f == cw::JV || f == cw::SP));
}
}  // namespace

void Drive::submit_stop(const Command& command, Turn& t) {
    Stop s;
    s.kind = std::holds_alternative<Disable>(command.body) ? StopKind::off
             : std::holds_alternative<Halt>(command.body)  ? StopKind::halt
                                                           : StopKind::quick;
    s.ticket = command.ticket;
    s.until_done = command.until_done;
    interrupt_motions(name_of(command.body), s.kind != StopKind::halt, t);
    add_stop(s, t);
}

/// Ends every motion of this axis that waits or runs.
void Drive::interrupt_motions(std::string_view by, bool power_off, Turn& t) {
    const std::string text = drive::CommandQueue::interrupted_by(by);
    const auto ends = [&](const CommandBody& body) {
        return drive::is_motion(body) || (power_off && std::holds_alternative<Enable>(body));
    };
    if (searching()) search_over(false, Reason::interrupted, text, t);
    if (job_.active && ends(job_.command.body)) {
        abandon_job_exchange();
        job_over(Outcome::failed, Reason::interrupted, text, t);
    }
    bool joined = false;
    (void)queue_.interrupt(
        [&](const Command& waiting) {
            joined = joined || is_place(waiting);
            return ends(waiting.body);
        },
        by, tickets_, t);
    end_waits(true, Reason::interrupted, text, t);
    if (joined) bus_.part_done(*this, {false, Reason::interrupted, 0, text}, t);
    prepared_ = false;
}

void Drive::add_stop(const Stop& wanted, Turn& t) {
    if (Stop* s = stops_.add(wanted)) return begin_stop(*s, t);
    // All places are taken by stops that nobody has acknowledged: this one is sent too, but cannot be watched.
    Message m = wanted.kind == StopKind::off ? msg_set(cw::MO, 0) : msg_act(cw::ST);
    m.cw &= static_cast<std::uint8_t>(~ack_bit);
    bus_.transmit(m, Priority::urgent, t);
    forget_demand();
    const std::string text = fmt::format("sent, but not watched: {} stops wait for their acknowledgement already", urgent_limit);
    result(wanted.ticket, Outcome::failed, Reason::busy, text, t);
    if (wanted.part) bus_.part_done(*this, {false, Reason::busy, 0, text}, t);
}

void Drive::begin_stop(Stop& s, Turn& t) {
    const int retries = bus_.timing.retries;
    const Message& on_its_way = exchange_.request().message;
    const bool motion_on_its_way = exchange_.active() && sets_motion(on_its_way);
    const bool start_on_its_way = (exchange_.active() && on_its_way.function() == cw::BG) || t.now < broadcast_until_;
    // A stop that gets between MF and its value may use the selection up: the pair is begun anew.
    if (job_.active && job_.at < job_.count) {
        const Step& step = job_.steps[job_.at];
        const bool own = exchange_.active() && exchange_.request().purpose == Purpose::job;
        if ((step.select && own) || (step.mf != 0 && !own)) job_.again = true;
    }
    if (s.kind == StopKind::off) {
        const bool turns_on = on_its_way.function() == cw::MO && form_of(on_its_way) == Form::set && on_its_way.d[0] != 0;
        if (exchange_.active() && turns_on) confirm_ = StopKind::off;
        return send_stop(s, msg_set(cw::MO, 0), retries, t);
    }
    if (s.kind == StopKind::halt && presence_.is(Phase::ready)) {
        // There is no instruction "stop on DC". A jog speed of 0 and BG decelerate with DC; ST would use SD. With AC and DC as
        // times the ramp to speed 0 is not defined, and at rest there is nothing to decelerate: then ST.
        // With a group of MF perhaps still selected JV could go astray: then ST too.
        const bool defined = time_ramps_ == false && t.now >= broadcast_until_ && !mf_unknown_;
        if (defined && motion_on_its_way) {
            // JV=0 could overtake a PA that BG would then start: after the exchange in progress, which is not repeated any more.
            s.soft = s.waiting = true;
            exchange_.no_repeats();
            return;
        }
        if (defined && fb_.moving && !stop_ramp_) {  // during an SD ramp BG is refused (0x3F)
            s.soft = true;
            s.step = 0;
            return send_stop(s, msg_set(cw::JV, 0), 0, t);
        }
    }
    s.soft = false;
    if (start_on_its_way) confirm_ = StopKind::quick;
    send_stop(s, msg_act(cw::ST), retries, t);
}

void Drive::waiting_stops(Turn& t) {
    stops_.each([&](Stop& s) {
        if (!s.waiting || (exchange_.active() && sets_motion(exchange_.request().message))) return;
        s.waiting = false;
        begin_stop(s, t);
    });
}

void Drive::send_stop(Stop& s, const Message& m, int retries, Turn& t) {
    s.exchange.begin(m, t.now, bus_.timing.reply_timeout, retries);
    bus_.transmit(m, Priority::urgent, t);
}

void Drive::stop_answered(Stop& s, const Message& m, Turn& t) {
    learn(s.exchange.request(), m, 0, true, t);
    if (s.kind == StopKind::off) {
        if (m.dl > 0 && m.d[0] != 0) {
            return stop_finished(s, Outcome::failed, Reason::drive_refused, "the drive acknowledged MO=0 with MO = 1: it is still on", 0,
                                 t);
        }
        motion_ = {};
        forget_demand();
        poll_now(t);
        return stop_finished(s, Outcome::accepted, Reason::none, "", 0, t);
    }
    if (s.soft && s.step == 0) {
        s.step = 1;
        return send_stop(s, msg_act(cw::BG), 0, t);
    }
    demand_stops(s.soft, t.now);
    if (s.soft) {
        motion_ = {Motion::Kind::velocity, 0, true, t.now, never};
        status_.paif = false;
        if (!s.by_supervision) supervise(true, t);
    } else {
        if (s.kind == StopKind::quick) stop_ramp_ = !status_.stop;
        if (!s.by_supervision) supervise(false, t);
    }
    derive(t);
    emit(t);
    poll_now(t);
    stop_finished(s, Outcome::accepted, Reason::none, "", 0, t);
}

void Drive::stop_refused(Stop& s, const Message& m, Turn& t) {
    const auto report = error_report_of(m);
    const std::uint8_t code = report ? report->code : std::uint8_t{0};
    if (s.soft)
        return harden(s, fmt::format("{} was refused ({})", describe_request(s.exchange.request()), describe_error(code)), false, t);
    stop_finished(s, Outcome::refused, Reason::drive_refused,
                  fmt::format("{}: the drive says {}", describe_request(s.exchange.request()), describe_error(code)), code, t);
}

void Drive::stop_silent(Stop& s, Turn& t) {
    late_.add(mark_of(s.exchange.request()));
    forget_demand();
    if (s.soft) return harden(s, fmt::format("{} was not acknowledged", describe_request(s.exchange.request())), s.step == 1, t);
    stop_finished(s, Outcome::failed, Reason::no_answer,
                  fmt::format("{} was sent {} times and not acknowledged: whether the axis stops is not known",
                              describe_request(s.exchange.request()), s.exchange.tries()),
                  0, t);
    poll_now(t);
    count_silence(t);
}

/// The way by DC did not work: ST. `late_begin`: its BG was not answered and may still come.
void Drive::harden(Stop& s, std::string_view why, bool late_begin, Turn& t) {
    notice(Severity::warning, "stop", 0, fmt::format("halt: {}; ST is sent instead", why), t);
    s.soft = false;
    if (late_begin) confirm_ = StopKind::quick;
    send_stop(s, msg_act(cw::ST), bus_.timing.retries, t);
}

void Drive::stop_finished(Stop& s, Outcome outcome, Reason reason, std::string text, std::int32_t code, Turn& t) {
    const Stop was = s;
    stops_.remove(&s);
    if (was.part) bus_.part_done(*this, {outcome == Outcome::accepted, reason, code, text}, t);
    if (outcome == Outcome::accepted) {
        return accepted(was.ticket, was.until_done, was.kind == StopKind::off ? WaitFor::off : WaitFor::standstill, 0, std::move(text), t);
    }
    result(was.ticket, outcome, reason, std::move(text), t, code);
}

/// The axis must stand within half as long again as its ramp takes, and 300 ms.
void Drive::supervise(bool soft, Turn& t) {
    const auto& rate = soft ? dc_ : sd_;
    double ramp_s = 2.0;
    if (rate && *rate > 0) ramp_s = static_cast<double>(std::llabs(fb_.velocity)) / static_cast<double>(*rate);
    if (!soft && sd_ == 0u) ramp_s = 0;
    ramp_s = std::min(ramp_s * 1.5 + 0.3, 60.0);
    supervise_at_ = t.now + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(ramp_s));
    supervise_soft_ = soft;
}

void Drive::supervision_due(Turn& t) {
    supervise_at_ = never;
    if (!fb_.moving || !online()) return;
    notice(Severity::warning, "stop", 0,
           fmt::format("the axis still moves after {}, at {} pulse/s; ST is sent", supervise_soft_ ? "a halt" : "a stop", fb_.velocity), t);
    Stop s;
    s.by_supervision = true;
    add_stop(s, t);
}

void Drive::stopped_by_all(Turn& t) {
    interrupt_motions("global_stop", true, t);
    Stop s;
    s.part = true;
    add_stop(s, t);
}

}  // namespace axisgate::uim342
