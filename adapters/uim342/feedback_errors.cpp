// Errors and Waits: reports, alarms and flags; and when a command that waits is over.
// In: what the drive says, what the axis shows. Out: notices, results, shares of joint orders.
// Never answers with a picture that is older than the command.
#include "adapters/uim342/feedback_errors.hpp"

#include <fmt/core.h>

#include <cstdlib>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
// Between the end of the ramp and "in position" a closed loop may settle.
constexpr Duration settle_time = std::chrono::milliseconds(500);

bool alarm_is_fault(std::uint8_t code) { return code != 0 && code != 0x1F; }
}  // namespace

bool Errors::fault(const Status& s) const noexcept {
    return s.lock || s.tlif || (s.err && cause_ == Cause::foreign && alarm_ != 0x1F) || alarm_is_fault(alarm_);
}

void Errors::on_status(const Status& s, bool err_is_new) noexcept {
    if (!s.err) {
        cause_ = Cause::none;
        if (!s.tlif && !s.lock) alarm_ = 0;
    } else if (err_is_new) {
        // Its cause is known if the drive has just refused something of ours; else it is taken for a fault.
        if (cause_ == Cause::none) cause_ = Cause::foreign;
        to_read_ = true;
    }
}

void Errors::refused_ours(const Message& m) noexcept {
    if (cause_ == Cause::none) cause_ = Cause::own;
    if (const auto report = error_report_of(m)) latest_ = report->code;
}

void Errors::read(Turn& t) {
    const Message m = drive_.get(cw::ER);
    if (drive_.exchanges.makes_way(m, 0, Priority::poll, t)) return;
    to_read_ = false;
    drive_.exchanges.send({m, Purpose::error}, 1, Priority::poll, t);
}

void Errors::on_latest(const Message& m, Turn& t) {
    const auto report = error_report_of(m);
    if (!report || (report->slot != 0 && report->slot != 10)) return;
    latest_ = report->code;
    const bool told = drive_.feedback.fb().error_code == report->code;
    drive_.feedback.derive(t);
    if (!told) drive_.feedback.emit(t);
}

void Errors::on_report(const Message& m, Turn& t) {
    ++drive_.bus.counters.unexpected;
    const auto report = error_report_of(m);
    if (!report) {
        ++drive_.bus.counters.garbled;
        return;
    }
    // ER[i] answers that come late, and "no error", are no news.
    if (!drive_.online() || report->slot != 0 || report->code == 0 || drive_.exchanges.late(drive_.get(cw::ER))) return;
    const std::uint8_t function = report->cw & 0x7F;
    Message about;
    about.cw = report->cw;
    const Instruction* i = instruction(report->cw);
    if (i && i->indexed) about = make_get(drive_.address(), *i, report->index);
    Message setting = about;
    if (i && i->answer == SetAnswer::desired) setting = make_set(drive_.address(), *i, 0, 0);
    const bool of_group_start = function == cw::BG && drive_.together.on_its_way(t.now);
    const bool of_blind = drive_.jobs.job().blind == function;
    const bool ours = of_group_start || of_blind || drive_.exchanges.late(about) || drive_.exchanges.late(setting);
    cause_ = ours && cause_ != Cause::foreign ? Cause::own : Cause::foreign;
    latest_ = report->code;
    const std::string request = name_of_request(report->cw, report->index), error = describe_error(report->code);
    drive_.notice(
        Severity::warning, "error_report", report->code,
        fmt::format("the drive reports error {} about {}{}", error, request, ours ? "" : ", which this gateway is not waiting for"), t);
    if (of_group_start) drive_.together.over({false, Reason::drive_refused, report->code, error}, t);
    if (of_blind) {
        // The refusal of an instruction that asked for no acknowledgement: it ends the job that is waiting behind it.
        drive_.exchanges.abandon_job();
        ++drive_.bus.counters.refused;
        drive_.jobs.over(Outcome::refused, Reason::drive_refused, fmt::format("{}: the drive says {}", request, error), t, report->code);
    }
    drive_.feedback.derive(t);
    drive_.polls.soon(t.now);
}

void Errors::on_alarm(std::uint8_t code, Turn& t) {
    const ErrorCode* known = drive_.bus.catalogue.error(code, "alarm");
    std::string text(known && !known->text.empty() ? std::string_view(known->text) : alarm_text(code));
    if (text.empty()) text = "not named by the manual";
    drive_.notice(alarm_is_fault(code) ? Severity::alarm : Severity::warning, "alarm", code, fmt::format("alarm 0x{:02X}: {}", code, text),
                  t);
    if (!drive_.online()) return;
    alarm_ = code;
    cause_ = Cause::foreign;
    drive_.feedback.update(t);
    drive_.waits.check(t);
    drive_.polls.soon(t.now);
}

// --- "done" ----------------------------------------------------------------------------------------------------------------------

void Waits::accepted(const Wait& wait, bool until_done, std::string text, Turn& t) {
    if (wait.ticket == no_ticket) return;
    const bool full = waits_.size() >= limit;
    if (until_done && !full) return add(wait, t);
    if (until_done) text = "accepted by the drive; too many commands wait for their end to watch this one";
    (void)drive_.tickets.accepted(wait.ticket, t.out, std::move(text));
}

void Waits::add(const Wait& wait, Turn& t) {
    waits_.push_back(wait);
    waits_.back().since = t.now;
    drive_.polls.soon(t.now);
}

Waits::Verdict Waits::verdict(const Wait& w, Instant now) const {
    const Feedback& feedback = drive_.feedback;
    const AxisFeedback& fb = feedback.fb();
    const bool fresh = feedback.status_at() >= w.since;  // seen after the drive took the command
    const bool power_off = fresh && fb.power == AxisFeedback::Power::off;
    switch (w.until) {
        case Until::standstill:
            return {fresh && !fb.moving};
        case Until::on:
            if (power_off) return {true, Reason::drive_refused, "the drive acknowledged MO=1 but is off"};
            return {fresh};
        case Until::off:
            return {power_off};
        case Until::boot:
            return {true};
        case Until::target:
        case Until::speed:
        case Until::share:
            break;
    }
    if (fb.fault) {
        return {true, Reason::interrupted,
                fmt::format("a fault ended it (drive's code 0x{:02X}); the axis is at {}", fb.error_code, fb.position)};
    }
    if (power_off) return {true, Reason::interrupted, fmt::format("the driver is off; the axis was at {}", fb.position)};
    const Motion& motion = feedback.motion();
    if (w.until == Until::speed || (w.until == Until::share && motion.kind == Motion::Kind::velocity)) {
        const bool at_speed = w.value == 0 ? !fb.moving : std::llabs(fb.velocity - w.value) * 100 <= std::llabs(w.value);
        if (fresh && at_speed) return {true};
    } else if (fb.target_reached) {
        return {true};
    }
    if (!fresh || fb.moving || motion.stood_since == never || now - motion.stood_since < settle_time) return {};
    return {true, Reason::interrupted,
            fmt::format("the axis stands at {} without having got there (an input action, or another master)", fb.position)};
}

void Waits::check(Turn& t) {
    for (std::size_t i = 0; i < waits_.size();) {
        const Wait w = waits_[i];
        Verdict v = verdict(w, t.now);
        if (!v.over) {
            ++i;
            continue;
        }
        waits_.erase(waits_.begin() + static_cast<std::ptrdiff_t>(i));
        answer(w, v.reason, std::move(v.text), drive_.feedback.fb().error_code, t);
    }
}

void Waits::answer(const Wait& w, Reason reason, std::string text, std::int32_t code, Turn& t) {
    const bool good = reason == Reason::none;
    if (w.until == Until::share) return drive_.bus.share_done(drive_, {good, reason, good ? 0 : code, std::move(text)}, t);
    (void)drive_.tickets.answer(w.ticket, good ? Outcome::done : Outcome::failed, reason, std::move(text), t.out, good ? 0 : code);
}

void Waits::end(bool motions_only, Reason reason, const std::string& text, Turn& t) {
    for (std::size_t i = 0; i < waits_.size();) {
        const Wait w = waits_[i];
        if (motions_only && w.until != Until::target && w.until != Until::speed && w.until != Until::share) {
            ++i;
            continue;
        }
        waits_.erase(waits_.begin() + static_cast<std::ptrdiff_t>(i));
        answer(w, reason, text, 0, t);
    }
    drive_.together.over({false, reason, 0, text}, t);
}

}  // namespace axisgate::uim342
