// Feedback and Errors: statuses, speeds and notifications, each with what it says of the last motion; reports, alarms and flags.
// In: messages of the drive. Out: the axis' picture, when it has changed; what follows for demand and homing.
// Never calls a standing axis at rest before its place was read behind its standstill.
#include "adapters/uim342/feedback.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
// All control loops end within 1 ms [L390]; a status older than this after BG may still be that of before.
constexpr Duration start_grace = std::chrono::milliseconds(5);

/// What doors and pages see of it without the place.
bool looks_other(const AxisFeedback& a, const AxisFeedback& b) {
    return a.power != b.power || a.moving != b.moving || a.target_reached != b.target_reached || a.fault != b.fault ||
           a.warning != b.warning || a.quick_stopping != b.quick_stopping || a.native_status != b.native_status;
}
bool alarm_is_fault(std::uint8_t code) { return code != 0 && code != 0x1F; }
}  // namespace

void Feedback::emit(Turn& t) {
    if (drive_.axis() == no_axis || !status_known_ || !position_known_) return;
    // Status and position are two answers: the picture is as old as the older of them.
    fb_.at = std::min(status_at_, position_at_);
    fb_.homing = drive_.homing.searching();
    fb_.rates = drive_.known.rates();
    fb_.course = course();
    fb_.safe_stop = safe_stop();
    drive_.demand.show(fb_);
    t.out.feedback.push_back({drive_.axis(), fb_});
}

/// What was ordered and acknowledged; else the mode of the status (JOG or PTP [L875]).
Course Feedback::course() const noexcept {
    using Kind = Motion::Kind;
    if (motion_.kind == Kind::velocity) return Course::endless;
    if (motion_.kind == Kind::absolute || motion_.kind == Kind::relative) return Course::to_target;
    return status_.mode == 0 ? Course::endless : status_.mode == 1 ? Course::to_target : Course::unknown;
}

/// An input stands behind the edge whose action is "driver off" or "emergency stop" (IL[i]: falling in the low byte, rising in the high one
/// [L1000]). Other stops are those of limit switches, which leave the way back free.
bool Feedback::safe_stop() const noexcept {
    const std::array<bool, 3> level{status_.in1, status_.in2, status_.in3};
    for (std::size_t i = 0; i < level.size(); ++i) {
        const auto& il = drive_.known.ram.il[i];
        const unsigned action = il ? (level[i] ? *il >> 8 : *il) & 0x7Fu : 0u;
        if (action == 1 || action == 2) return true;
    }
    return false;
}

void Feedback::learn(const Message& request, const Message& answer, std::uint8_t mf, bool samples, Turn& t) {
    if (samples) drive_.publish(answer, mf, t);
    if (answer.cw == cw::MS) {
        if (answer.dl < 8 || answer.d[0] > 1) return;
        return answer.d[0] == 0 ? on_status(answer, t) : on_speed(answer, t);
    }
    if (answer.cw == cw::ER) return drive_.errors.on_latest(answer, t);
    const auto value = value_of(request, answer);
    if (!value || mf != 0) return;
    if (request.function() != cw::MO) {
        drive_.known.learn(request, *value, t);
        if (drive_.known.rates() != fb_.rates || safe_stop() != fb_.safe_stop) emit(t);
        return;
    }
    status_.on = *value != 0;
    set_bit(0x04, status_.on);
    // On: only when MS[0] shows it, because a status can be older than MO (the driver is not on at once, or the flags are late).
    off_at_ = status_.on ? Instant{} : t.now;
    if (!status_.on) power_expected_ = false;
    if (!status_.on) drive_.together.unprepare();
    update(t);
}

void Feedback::on_status(const Message& m, Turn& t) {
    const Status before = status_;
    const bool had = status_known_;
    status_ = status_of(m);
    status_known_ = true;
    status_at_ = t.now;
    stop_shown_ = status_.stop;
    if (!status_.stop) {
        if (had && before.stop && motion_.seen_moving) motion_.kind = Motion::Kind::unknown;  // an input, or somebody else, has begun it
        motion_.seen_moving = true;
        rest_unread_ = false;
    } else {
        drive_.stops.ramp_over();
        // Place and speed of a standing axis are those that were read after it stood: until then it is not called at rest.
        if (fb_.moving && position_known_) {
            rest_unread_ = true;
            drive_.polls.speed_next();
        }
    }
    drive_.errors.on_status(status_, !had || !before.err);
    const bool went_off = had && before.on && !status_.on && power_expected_;
    const bool before_off = off_at_ != Instant{} && t.now - off_at_ < status_doubt;  // it may be older than MO = 0
    power_expected_ = status_.on && !before_off;
    const AxisFeedback old = fb_;
    derive(t);
    drive_.demand.at_status(had && before.stop && !status_.stop, t.now);
    if (looks_other(old, fb_)) emit(t);
    if (went_off) {
        drive_.together.unprepare();
        suspect_restart("the driver went off without being told to (input action, stall, or a restart)", t);
    }
    drive_.homing.on_status(t);
    drive_.start.back(t);
}

void Feedback::on_speed(const Message& m, Turn& t) {
    const std::int64_t position = get_i32(&m.d[4]);
    // A restart begins at 0; nothing else takes a standing axis there but an origin that somebody else has set.
    const bool lost = position_known_ && status_known_ && position == 0 && std::llabs(fb_.position) > 1 && status_.stop && !fb_.moving &&
                      !status_.on && fb_.velocity == 0 && drive_.known.absolute_encoder != true;
    fb_.velocity = get_i24(&m.d[1]);
    fb_.position = position;
    position_known_ = true;
    position_at_ = t.now;
    rest_unread_ = false;
    derive(t);
    drive_.demand.at_position(t.now);
    if (lost) {
        zero_lost();
        suspect_restart("the position of the standing axis fell to 0: it was restarted, or somebody else has set its origin", t);
    }
    emit(t);
}

/// A status that says that the axis stands, soon behind its BG, is that of before BG unless the axis is at its goal, where it can have been
/// led between two statuses.
bool Feedback::status_is_older(Instant now) const noexcept {
    if (motion_.kind == Motion::Kind::none) return false;
    const Duration since = now - motion_.begun;
    if (!motion_.seen_moving && since < start_grace) return true;
    if (motion_.seen_moving && motion_.from_rest) return false;
    if (!motion_.goal || since >= status_doubt || !status_.on || status_.lock || status_.tlif || drive_.errors.at_limit()) return false;
    if (position_at_ <= motion_.begun || fb_.velocity != 0) return true;
    constexpr std::int64_t least_play = 3, most_play = 50;  // noise, friction and play of a shaft at its goal
    const std::int64_t play = std::clamp<std::int64_t>(std::llabs(*motion_.goal - motion_.from) / 2, least_play, most_play);
    return std::llabs(fb_.position - *motion_.goal) > play;
}

/// Status, alarms and what we know of the last motion, as the axis profile sees them.
void Feedback::derive(Turn& t) {
    const bool starting = status_.stop && status_is_older(t.now);
    fb_.power = status_.on ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    fb_.moving = !status_.stop || starting || rest_unread_;
    fb_.target_reached = status_.paif && !fb_.moving && motion_.kind != Motion::Kind::velocity;
    fb_.fault = drive_.errors.fault(status_);
    fb_.warning = drive_.errors.warning(status_);
    fb_.internal_limit = drive_.errors.at_limit();
    fb_.quick_stopping = status_.lock || (drive_.stops.ramp() && fb_.moving);
    fb_.error_code = drive_.errors.code(status_);
    fb_.native_status = status_.raw;
}

// --- notifications ---------------------------------------------------------------------------------------------------------------

void Feedback::on_notification(const Message& m, Turn& t) {
    const Notification n = notification_of(m);
    drive_.presence.received(t.now);
    if (n.kind == Notification::Kind::alarm) return drive_.errors.on_alarm(n.code, t);
    if (n.kind == Notification::Kind::input) return on_input(n, t);
    if (n.kind == Notification::Kind::finished && n.has_position) return on_finished(n, t);
    ++drive_.bus.counters.garbled;
    if (n.kind == Notification::Kind::unknown) drive_.notice(Severity::info, "protocol", n.code, describe_answer(m), t);
}

/// Its action may have stopped the axis, started it, or called the place 0: only an input that is known to have none changes nothing.
void Feedback::on_input(const Notification& n, Turn& t) {
    drive_.notice(Severity::info, "input", n.code, fmt::format("IN{} {}", n.input, n.rising ? "rising" : "falling"), t);
    if (!drive_.presence.online()) return;
    (n.input == 1 ? status_.in1 : n.input == 2 ? status_.in2 : status_.in3) = n.rising;
    if (const auto& il = drive_.known.ram.il[static_cast<std::size_t>(n.input - 1)]; !il || (*il & 0x7F7F) != 0) drive_.demand.forget();
    set_bit(0x08u << (n.input - 1), n.rising);
    fb_.native_status = status_.raw;
    emit(t);
    drive_.polls.again(t.now);
}

void Feedback::on_finished(const Notification& n, Turn& t) {
    drive_.notice(Severity::info, "motion", n.code, fmt::format("PTP motion finished at {}", n.position), t);
    if (!drive_.presence.online()) return;
    // It may still be the end of the motion before: only the target of the present one proves that it is this one.
    if (motion_.kind == Motion::Kind::absolute && motion_.target == n.position && !drive_.exchanges.on_its_way(cw::BG)) {
        motion_.seen_moving = true;
        status_.stop = status_.paif = true;
        set_bit(0x0300, true);
        fb_.velocity = 0;
        fb_.position = n.position;
        status_at_ = position_at_ = t.now;
        rest_unread_ = false;
        derive(t);
        drive_.demand.at_position(t.now);
        emit(t);
    }
    drive_.polls.soon(t.now);
}

/// What was known of its RAM may be wrong now: reads it again while the axis stays in use.
void Feedback::suspect_restart(std::string why, Turn& t) {
    drive_.demand.forget();
    drive_.notice(Severity::warning, "presence", 0, why + "; its values are read again", t);
    drive_.start.read_again();
}

// --- what was ordered ------------------------------------------------------------------------------------------------------------

void Feedback::begin_motion(const Motion& motion, Turn& t) {
    drive_.together.over({false, Reason::interrupted, 0, "another motion of the same axis began"}, t);
    drive_.demand.begins(motion, t.now);
    motion_ = motion;
    motion_.seen_moving = false;
    motion_.begun = t.now;
    motion_.from_rest = stop_shown_;
    motion_.from = fb_.position;
    motion_.goal.reset();
    const bool stands = !fb_.moving && position_known_;
    if (motion.kind == Motion::Kind::absolute) motion_.goal = motion.target;
    if (motion.kind == Motion::Kind::relative && stands) motion_.goal = fb_.position + motion.target;
    drive_.stops.ramp_over();
    drive_.together.unprepare();
    rest_unread_ = false;
    status_.stop = false;  // until the next MS[0] says otherwise
    status_.paif = false;
    update(t);
    drive_.polls.soon(t.now);
}

void Feedback::slows_down(Instant now) noexcept {
    motion_ = {.kind = Motion::Kind::velocity, .begun = now};
    status_.paif = false;
}

/// "Clear the position counter" [L1508].
void Feedback::origin_set(bool homed, Turn& t) {
    fb_.referenced = true;
    fb_.homing_error = false;
    if (homed) fb_.homing_attained = true;
    drive_.demand.rests(fb_.position = 0);
    position_at_ = t.now;
    motion_ = {};
    update(t);
    drive_.polls.soon(t.now);
}

void Feedback::homing_ended(bool good, Turn& t) {
    if (good) fb_.referenced = fb_.homing_attained = true;
    if (!good) fb_.homing_error = true;
    emit(t);
}

void Feedback::found() noexcept {
    status_known_ = position_known_ = rest_unread_ = false;
    motion_ = {};
    fb_.target_reached = fb_.homing_error = false;
}

// --- errors ----------------------------------------------------------------------------------------------------------------------

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
    const bool reported = drive_.feedback.fb().error_code == report->code;
    drive_.feedback.derive(t);
    if (!reported) drive_.feedback.emit(t);
}

void Errors::on_report(const Message& m, Turn& t) {
    ++drive_.bus.counters.unexpected;
    const auto report = error_report_of(m);
    if (!report) {
        ++drive_.bus.counters.garbled;
        return;
    }
    // ER[i] answers that come late, and "no error", are no news.
    if (!drive_.presence.online() || report->slot != 0 || report->code == 0 || drive_.exchanges.late(drive_.get(cw::ER))) return;
    const std::uint8_t function = report->cw & 0x7F;
    Message about;
    about.cw = report->cw;
    const Instruction* i = instruction(report->cw);
    if (i && i->indexed) about = make_get(drive_.address(), *i, report->index);
    Message setting = about;
    if (i && i->answer == SetAnswer::desired) setting = make_set(drive_.address(), *i, 0, 0);
    const bool of_group_start = function == cw::BG && drive_.together.on_its_way(t.now);
    const bool of_blind = drive_.jobs.job().blind == function;
    if (of_group_start) drive_.feedback.no_goal();
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
        drive_.jobs.over({Outcome::refused, Reason::drive_refused, fmt::format("{}: the drive says {}", request, error), report->code}, t);
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
    if (!drive_.presence.online()) return;
    alarm_ = code;
    cause_ = Cause::foreign;
    drive_.feedback.update(t);
    drive_.polls.soon(t.now);
}

}  // namespace axisgate::uim342
