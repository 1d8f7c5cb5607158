// Drive, part status: what the drive says of itself, turned into the axis' feedback, samples and notices; and the waits for "done".
// In: answers, notifications (RT), error reports. Out: feedback, samples, notices, results of commands that waited for the end.
// Never invents: PAIF alone says that a target was reached, STOP that the axis stands, SON that it is on.
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
// All control loops end within 1 ms [L390]; a status older than this after BG may still be that of before.
constexpr Duration start_grace = std::chrono::milliseconds(5);
// Between the end of the ramp and "in position" a closed loop may settle.
constexpr Duration settle_time = std::chrono::milliseconds(500);

bool alarm_is_fault(std::uint8_t code) { return code != 0 && code != 0x1F; }

void set_bit(std::uint32_t& raw, std::uint32_t bit, bool on) { raw = on ? raw | bit : raw & ~bit; }
}  // namespace

bool Drive::moving_now() const noexcept { return fb_.moving || search_.running || job_.active; }

void Drive::emit(Turn& t) {
    if (axis_ == no_axis || !status_known_ || !position_known_) return;
    // Status and position are two answers: the picture is as old as the older of them.
    fb_.at = std::min(status_at_, position_at_);
    fb_.homing = searching();
    t.out.feedback.push_back({axis_, fb_});
}

/// Everything that an answer tells, whoever asked for it.
void Drive::learn(const Message& request, const Message& answer, std::uint8_t mf, bool samples, Turn& t) {
    if (samples) {
        bus_.points.each(answer, mf, [&](const Binding& b, Value v) {
            t.out.samples.push_back({axis_, b.point, std::move(v), Quality::good, t.now});
        });
    }
    if (answer.cw == cw::MS) {
        if (answer.dl < 8) return;
        return answer.d[0] == 0 ? on_status(answer, t) : answer.d[0] == 1 ? on_speed(answer, t) : void();
    }
    if (answer.cw == cw::ER) return on_latest_error(answer, t);
    const auto value = value_of(request, answer);
    if (!value || mf != 0) return;
    const std::uint8_t index = request.dl > 0 ? request.d[0] : 0;
    switch (request.function()) {
        case cw::MO:
            status_.on = *value != 0;
            set_bit(status_.raw, 0x04, status_.on);
            power_expected_ = status_.on;
            if (!status_.on) prepared_ = false;
            derive(t);
            emit(t);
            break;
        case cw::AC:
            ac_ = static_cast<std::uint32_t>(*value);
            break;
        case cw::DC:
            dc_ = static_cast<std::uint32_t>(*value);
            break;
        case cw::SS:
            ss_ = static_cast<std::uint32_t>(*value);
            break;
        case cw::SD:
            sd_ = static_cast<std::uint32_t>(*value);
            break;
        case cw::SP:
            if (form_of(request) == Form::set && *value != 0) ptp_speed_ = static_cast<std::uint32_t>(std::llabs(*value));
            break;
        case cw::DV:
            if (index == 2 && *value != 0 && !ptp_speed_) ptp_speed_ = static_cast<std::uint32_t>(std::llabs(*value));
            break;
        case cw::IC:
            if (index == 0) auto_on_ = *value != 0;
            if (index == 4) time_ramps_ = *value != 0;
            if (index == 5) absolute_encoder_ = *value != 0;
            if (index == 6) closed_loop_ = *value != 0;
            break;
        case cw::QE:
            if (index == 3) battery_ok_ = *value != 0;
            break;
        case cw::IE:
            if (index == 8) notifies_ = *value != 0;
            break;
        case cw::IL:
            if (index < 3) il_[index] = static_cast<std::uint16_t>(*value);
            break;
        case cw::TG:
            if (index < 3) tg_[index] = static_cast<std::uint16_t>(*value);
            break;
        case cw::PP:
            if (!reading_.pending() || form_of(request) != Form::get) break;  // what is written acts after a restart only [L1064]
            if (index == 8) {
                group_ = static_cast<std::uint8_t>(*value);
                if (const auto other = bus_.user_of(*group_, *this);
                    *group_ == address_ || (!other.empty() && other.ends_with("node ID"))) {
                    notice(Severity::warning, "setup", 0,
                           fmt::format("group ID {} is also a node ID ({}): no two IDs of a network may coincide", *group_,
                                       *group_ == address_ ? "its own" : other),
                           t);
                }
            }
            if (index == 7 && *value != address_) {
                notice(Severity::warning, "setup", 0,
                       fmt::format("it answers as ID {} but has ID {} stored: after its next restart it will be found there", address_,
                                   *value),
                       t);
            }
            if (index == 5 && bus_.kind == LineKind::can && bus_.bit_rate != 0 && *value <= 4) {
                constexpr std::array<std::uint32_t, 5> rates{1'000'000, 800'000, 500'000, 250'000, 125'000};
                const auto stored = rates[static_cast<std::size_t>(*value)];
                if (stored != bus_.bit_rate) {
                    notice(Severity::warning, "setup", 0,
                           fmt::format("it has {} bit/s stored, the line runs at {}: after its next restart it will be silent", stored,
                                       bus_.bit_rate),
                           t);
                }
            }
            break;
        default:
            break;
    }
}

void Drive::on_status(const Message& m, Turn& t) {
    const Status before = status_;
    const bool had = status_known_;
    status_ = status_of(m);
    status_known_ = true;
    status_at_ = t.now;
    if (!status_.stop) motion_.seen_moving = true;
    if (status_.stop) {
        stop_ramp_ = false;
        supervise_at_ = never;
        if (motion_.stood_since == never) motion_.stood_since = t.now;
        // Place and speed of a standing axis are those that were read after it stood: until then it is not called at rest.
        if (fb_.moving && position_known_) rest_unread_ = poll_speed_ = true;
    } else {
        motion_.stood_since = never;
        rest_unread_ = false;
    }
    if (!status_.err) {
        cause_ = Cause::none;
        if (!status_.tlif && !status_.lock) alarm_ = 0;
    } else if (!had || !before.err) {
        // Its cause is known if the drive has just refused something of ours; else it is taken for a fault.
        if (cause_ == Cause::none) cause_ = Cause::foreign;
        read_error_ = true;
    }
    const bool went_off = had && before.on && !status_.on && power_expected_;
    power_expected_ = status_.on;
    const AxisFeedback old = fb_;
    derive(t);
    demand_at_status(had && before.stop && !status_.stop, t.now);
    if (old.power != fb_.power || old.moving != fb_.moving || old.target_reached != fb_.target_reached || old.fault != fb_.fault ||
        old.warning != fb_.warning || old.quick_stopping != fb_.quick_stopping || old.native_status != fb_.native_status) {
        emit(t);
    }
    if (went_off) {
        prepared_ = false;
        suspect_restart(t, false, "the driver went off without being told to (input action, stall, or a restart)");
    }
    search_status(t);
    check_waits(t);
}

void Drive::on_speed(const Message& m, Turn& t) {
    const std::int64_t position = get_i32(&m.d[4]);
    // A restart begins at 0; nothing else takes a standing axis there but an origin that somebody else has set.
    const bool lost = position_known_ && status_known_ && position == 0 && std::llabs(fb_.position) > 1 && status_.stop && !fb_.moving &&
                      !status_.on && fb_.velocity == 0 && absolute_encoder_ != true;
    fb_.velocity = get_i24(&m.d[1]);
    fb_.position = position;
    position_known_ = true;
    position_at_ = t.now;
    rest_unread_ = false;
    derive(t);
    demand_at_position(t.now);
    if (lost) {
        suspect_restart(t, true, "the position of the standing axis fell to 0: it was restarted, or somebody else has set its origin");
    }
    emit(t);
    check_waits(t);
}

/// Status, alarms and what we know of the last motion, as the axis profile sees them.
void Drive::derive(Turn& t) {
    const bool starting = motion_.kind != Motion::Kind::none && !motion_.seen_moving && t.now - motion_.begun < start_grace;
    fb_.power = status_.on ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    fb_.moving = !status_.stop || starting || rest_unread_;
    fb_.target_reached = status_.paif && !fb_.moving && motion_.kind != Motion::Kind::velocity;
    fb_.fault = status_.lock || status_.tlif || (status_.err && cause_ == Cause::foreign && alarm_ != 0x1F) || alarm_is_fault(alarm_);
    fb_.warning = !fb_.fault && (status_.err || alarm_ != 0);
    fb_.internal_limit = alarm_ == 0x1A || alarm_ == 0x1B;
    fb_.quick_stopping = status_.lock || (stop_ramp_ && fb_.moving);
    fb_.error_code = alarm_ != 0 ? alarm_ : status_.err ? latest_error_ : std::uint16_t{0};
    fb_.native_status = status_.raw;
}

void Drive::on_latest_error(const Message& m, Turn& t) {
    const auto report = error_report_of(m);
    if (!report || (report->slot != 0 && report->slot != 10)) return;
    latest_error_ = report->code;
    const bool told = fb_.error_code == report->code;
    derive(t);
    if (!told) emit(t);
}

void Drive::on_error_report(const Message& m, Turn& t) {
    ++bus_.counters.unexpected;
    const auto report = error_report_of(m);
    if (!report) {
        ++bus_.counters.garbled;
        return;
    }
    // ER[i] answers that come late, and "no error", are no news.
    if (!online() || report->slot != 0 || report->code == 0 || late_.has(mark_of(msg_get(cw::ER, 0)))) return;
    const std::uint8_t function = report->cw & 0x7F;
    Message about;
    about.cw = report->cw;
    const Instruction* i = instruction(report->cw);
    if (i && i->indexed) about = make_get(address_, *i, report->index);
    Message setting = about;
    if (i && i->answer == SetAnswer::desired) setting = make_set(address_, *i, 0, 0);
    const bool of_group_start = function == cw::BG && t.now < broadcast_until_;
    const bool of_blind = blind_ == function && job_.active;
    const bool ours = of_group_start || of_blind || late_.has(mark_of(about)) || late_.has(mark_of(setting));
    cause_ = ours && cause_ != Cause::foreign ? Cause::own : Cause::foreign;
    latest_error_ = report->code;
    notice(Severity::warning, "error_report", report->code,
           fmt::format("the drive reports error {} about {}{}", describe_error(report->code), name_of_request(report->cw, report->index),
                       ours ? "" : ", which this gateway is not waiting for"),
           t);
    if (of_group_start && part_pending_) {
        part_pending_ = false;
        bus_.part_done(*this, {false, Reason::drive_refused, report->code, describe_error(report->code)}, t);
    }
    if (of_blind) {
        // The refusal of an instruction that asked for no acknowledgement: it ends the job that is waiting behind it.
        abandon_job_exchange();
        ++bus_.counters.refused;
        job_over(Outcome::refused, Reason::drive_refused,
                 fmt::format("{}: the drive says {}", name_of_request(report->cw, report->index), describe_error(report->code)), t,
                 report->code);
    }
    derive(t);
    poll_now(t);
}

void Drive::on_notification(const Message& m, Turn& t) {
    const Notification n = notification_of(m);
    presence_.heard(t.now);
    switch (n.kind) {
        case Notification::Kind::unknown:
            ++bus_.counters.garbled;
            notice(Severity::info, "protocol", n.code, describe_answer(m), t);
            return;
        case Notification::Kind::alarm: {
            const ErrorCode* known = bus_.catalogue.error(n.code, "alarm");
            const std::string_view own = alarm_text(n.code);
            notice(alarm_is_fault(n.code) ? Severity::alarm : Severity::warning, "alarm", n.code,
                   fmt::format("alarm 0x{:02X}: {}", n.code,
                               known && !known->text.empty() ? known->text
                               : own.empty()                 ? std::string("not named by the manual")
                                                             : std::string(own)),
                   t);
            if (!online()) return;
            alarm_ = n.code;
            cause_ = Cause::foreign;
            derive(t);
            emit(t);
            check_waits(t);
            poll_now(t);
            return;
        }
        case Notification::Kind::input:
            notice(Severity::info, "input", n.code, fmt::format("IN{} {}", n.input, n.rising ? "rising" : "falling"), t);
            if (!online()) return;
            (n.input == 1 ? status_.in1 : n.input == 2 ? status_.in2 : status_.in3) = n.rising;
            // Its action may stop the axis, start it, or call the place 0: only an input that is known to have none changes nothing.
            if (const auto& il = il_[static_cast<std::size_t>(n.input - 1)]; !il || (*il & 0x7F7F) != 0) forget_demand();
            set_bit(status_.raw, 0x08u << (n.input - 1), n.rising);
            fb_.native_status = status_.raw;
            emit(t);
            poll_now(t);  // the action of this input may have stopped or started the axis
            return;
        case Notification::Kind::finished:
            break;
    }
    if (!n.has_position) {
        ++bus_.counters.garbled;
        return;
    }
    notice(Severity::info, "motion", n.code, fmt::format("PTP motion finished at {}", n.position), t);
    if (!online()) return;
    // It may still be the end of the motion before: only the target of the present one proves that it is this one.
    const bool new_one = exchange_.active() && exchange_.request().message.function() == cw::BG;
    if (motion_.kind == Motion::Kind::absolute && motion_.target == n.position && !new_one) {
        motion_.seen_moving = true;
        status_.stop = status_.paif = true;
        set_bit(status_.raw, 0x0300, true);
        fb_.velocity = 0;
        fb_.position = n.position;
        status_at_ = position_at_ = t.now;
        rest_unread_ = false;
        derive(t);
        demand_at_position(t.now);
        emit(t);
        check_waits(t);
    }
    poll_now(t);
}

/// What was known of its RAM may be wrong now: reads it again while the axis stays in use.
void Drive::suspect_restart(Turn& t, bool zero_lost, std::string why) {
    if (zero_lost) fb_.referenced = fb_.homing_attained = false;
    forget_demand();
    notice(Severity::warning, "presence", 0, why + "; its values are read again", t);
    if (!reading_.pending()) begin_reading(t, false);
}

// --- motions and "done" ----------------------------------------------------------------------------------------------------------

/// The drive has acknowledged the start of a motion.
void Drive::begin_motion(const Motion& motion, Turn& t) {
    end_waits(true, Reason::interrupted, "another motion of the same axis began", t);
    demand_begins(motion, t.now);
    motion_ = motion;
    motion_.seen_moving = false;
    motion_.begun = t.now;
    motion_.stood_since = never;
    stop_ramp_ = false;
    prepared_ = false;
    supervise_at_ = never;
    rest_unread_ = false;
    status_.stop = false;  // until the next MS[0] says otherwise
    status_.paif = false;
    derive(t);
    emit(t);
    poll_now(t);
}

void Drive::accepted(Ticket ticket, bool until_done, WaitFor what, std::int64_t value, std::string text, Turn& t) {
    if (ticket == no_ticket) return;
    if (!until_done) return result(ticket, Outcome::accepted, Reason::none, std::move(text), t);
    if (waits_.size() >= wait_limit) {
        return result(ticket, Outcome::accepted, Reason::none,
                      "accepted by the drive; too many commands wait for their end to watch this one", t);
    }
    add_wait(what, ticket, value, t);
}

void Drive::add_wait(WaitFor what, Ticket ticket, std::int64_t value, Turn& t) {
    waits_.push_back({what, ticket, value, t.now});
    poll_now(t);
}

void Drive::check_waits(Turn& t) {
    for (std::size_t i = 0; i < waits_.size();) {
        const Wait w = waits_[i];
        const bool fresh = status_at_ >= w.since;  // seen after the drive took the command
        const bool motion = w.what == WaitFor::target || w.what == WaitFor::speed || w.what == WaitFor::part;
        std::optional<bool> good;
        std::string text;
        Reason reason = Reason::none;
        if (motion && fb_.fault) {
            good = false;
            reason = Reason::interrupted;
            text = fmt::format("a fault ended it (drive's code 0x{:02X}); the axis is at {}", fb_.error_code, fb_.position);
        } else if (motion && fresh && fb_.power == AxisFeedback::Power::off) {
            good = false;
            reason = Reason::interrupted;
            text = fmt::format("the driver is off; the axis was at {}", fb_.position);
        } else {
            const bool stands = fresh && !fb_.moving && motion_.stood_since != never && t.now - motion_.stood_since >= settle_time;
            const bool to_speed = w.what == WaitFor::speed || (w.what == WaitFor::part && motion_.kind == Motion::Kind::velocity);
            switch (to_speed ? WaitFor::speed : w.what) {
                case WaitFor::target:
                case WaitFor::part:
                    if (fb_.target_reached) good = true;
                    break;
                case WaitFor::speed:
                    if (fresh && (w.value == 0 ? !fb_.moving : std::llabs(fb_.velocity - w.value) * 100 <= std::llabs(w.value)))
                        good = true;
                    break;
                case WaitFor::standstill:
                    if (fresh && !fb_.moving) good = true;
                    break;
                case WaitFor::on:
                    if (fresh) good = fb_.power == AxisFeedback::Power::on;
                    if (good == false) {
                        reason = Reason::drive_refused;
                        text = "the drive acknowledged MO=1 but is off";
                    }
                    break;
                case WaitFor::off:
                    if (fresh && fb_.power == AxisFeedback::Power::off) good = true;
                    break;
                case WaitFor::boot:
                    good = true;
                    break;
            }
            if (!good && motion && stands) {
                good = false;
                reason = Reason::interrupted;
                text = fmt::format("the axis stands at {} without having got there (an input action, or another master)", fb_.position);
            }
        }
        if (!good) {
            ++i;
            continue;
        }
        waits_.erase(waits_.begin() + static_cast<std::ptrdiff_t>(i));
        if (w.what == WaitFor::part) {
            bus_.part_done(*this, {*good, reason, *good ? 0 : fb_.error_code, std::move(text)}, t);
        } else {
            result(w.ticket, *good ? Outcome::done : Outcome::failed, reason, std::move(text), t, *good ? 0 : fb_.error_code);
        }
    }
}

void Drive::end_waits(bool motions_only, Reason reason, const std::string& text, Turn& t) {
    for (std::size_t i = 0; i < waits_.size();) {
        const Wait w = waits_[i];
        if (motions_only && w.what != WaitFor::target && w.what != WaitFor::speed && w.what != WaitFor::part) {
            ++i;
            continue;
        }
        waits_.erase(waits_.begin() + static_cast<std::ptrdiff_t>(i));
        if (w.what == WaitFor::part) {
            bus_.part_done(*this, {false, reason, 0, text}, t);
        } else {
            result(w.ticket, Outcome::failed, reason, text, t);
        }
    }
    if (part_pending_) {
        part_pending_ = false;
        bus_.part_done(*this, {false, reason, 0, text}, t);
    }
}

}  // namespace axisgate::uim342
