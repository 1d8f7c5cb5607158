// An error is reported as an alarm once, as long as it persists.
#include "adapters/linmot/feedback.hpp"

#include <fmt/core.h>

#include <cmath>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {

std::string Feedback::error_text() const {
    const std::uint8_t code = status_.sub_state();
    const ErrorCode* e = drive_.bus.catalogue.error(code);
    if (!e) return fmt::format("error {:02X}h, which is in no list of the motion control software", code);
    return fmt::format("error {:04X}h, {}: {} {}", code, e->text, e->cause, e->remedy);
}

std::string Feedback::state_text() const {
    const auto* list = drive_.bus.catalogue.document().if_contains("states");
    for (const auto& s : list->get_array()) {
        if (s.get_object().at("code").as_int64() == status_.state())
            return fmt::format("state {}, {}", status_.state(), std::string_view(s.get_object().at("name").as_string()));
    }
    return fmt::format("state {}", status_.state());
}

void Feedback::sample(std::string_view id, Value value, Turn& t) {
    if (const auto point = drive_.bus.catalogue.find(id))
        t.out.samples.push_back({drive_.axis(), *point, std::move(value), Quality::good, t.now, 0});
}

void Feedback::forget() noexcept {
    known_ = operated_ = placed_ = power_shown_ = false;
    asked_at_.reset();
    track_.clear();
}

void Feedback::learn(const Status& s, Turn& t) {
    const bool first = !std::exchange(known_, true);
    const Status before = std::exchange(status_, s);
    placed_ = placed_ || s.placed;
    if (!s.placed) status_.position = before.position;
    ControlWord& control = drive_.control;
    drive_.motion.seen(s, t);
    control.shown(s);
    keep_error();
    watch_errors(t);
    if (!first && s.state() == state::not_ready && before.state() > state::disabled && drive_.jobs.idle() && control.word() != cw_off) {
        drive_.notice(Severity::warning, "presence", 0, fmt::format("drive {} has restarted", drive_.title()), t);
        control.cleared();
        operated_ = kept_ = braked_ = false;
    }
    watch_power(t);
    // The position has been redefined: the difference is not a motion.
    if (before.state() == state::homing && before.sub_state() != finished && (s.state() != state::homing || s.sub_state() == finished))
        track_.clear();
    if (s.placed) track(s, t.now);
    drive_.homing.watch(t);
    publish(t);
    if (drive_.axis() == no_axis) return;
    if (first || before.status != s.status) sample("StatusWord", std::int64_t{s.status}, t);
    if (first || before.state_var != s.state_var) sample("StateVar", std::int64_t{s.state_var}, t);
}

/// Status bit 3 is set while the motor decelerates because of an error; without bit 0 or 1 of the control word the drive never enters its
/// error state.
void Feedback::keep_error() noexcept {
    const Status& s = status_;
    if (in_error()) {
        braked_ = kept_ = false;
    } else if (s.state() >= state::enabled && s.bit(bit::error)) {
        braked_ = true;
    } else if (braked_ && s.state() < state::enabled) {
        braked_ = false;
        kept_ = true;
    } else if (braked_ && s.state() == state::enabled) {
        braked_ = false;
    }
}

/// The safe voltage enable or another input has removed the power, and the control word would restore it together with the input: it is
/// withdrawn.
void Feedback::watch_power(Turn& t) {
    const Status& s = status_;
    if (s.state() >= state::enabled) {
        operated_ = true;
        return;
    }
    if (in_error()) return;
    if ((drive_.control.word() & 0x0F) != 0x0F) operated_ = false;  // the control word does not request operation: OFF1, OFF3
    if (!operated_ || drive_.jobs.is(drive_.power) || drive_.jobs.is(drive_.reset) || !drive_.stops.empty()) return;
    operated_ = false;
    drive_.stops.take_back(Disable{}, t);
    drive_.notice(
        Severity::warning, "power", 0,
        fmt::format("drive {} has left operation by itself ({}): enable it again when that is over", drive_.title(), state_text()), t);
}

/// Status bit 4 shows bit 1 of the effective control word, to which X4.12 (SVE) is always mapped [L4400]. A response may be older than the
/// control word that it answers, so a bit 4 that has not been set since bit 1 was requested shows nothing yet.
bool Feedback::power_taken(Instant now) noexcept {
    if ((drive_.control.word() & 2) == 0) {
        asked_at_.reset();
        power_shown_ = false;
        return false;
    }
    if (!asked_at_) asked_at_ = now;
    power_shown_ = power_shown_ || status_.bit(4);
    return !status_.bit(4) && status_.state() != state::not_ready && (power_shown_ || now - *asked_at_ >= shown_within);
}

/// A halt decelerates with the rate of the last move (demand.hpp), a move without a rate with that of the drive: the lower one is shown.
DriveRates Feedback::rates() const noexcept {
    const Limits& own = drive_.limits;
    DriveRates r;
    r.velocity = std::int64_t{10} * own.velocity.value_or(0);
    r.acceleration = std::int64_t{100} * own.acceleration.value_or(0);
    const std::int64_t of_drive = std::int64_t{100} * own.deceleration.value_or(0),
                       of_move = std::int64_t{100} * drive_.demand.ordered_deceleration();
    r.deceleration = of_drive > 0 && of_move > 0 ? std::min(of_drive, of_move) : std::max(of_drive, of_move);
    return r;
}

void Feedback::watch_errors(Turn& t) {
    if (!in_error()) {
        reported_error_ = 0;
        return;
    }
    const std::uint8_t code = status_.sub_state();
    if (std::exchange(reported_error_, code) != code)
        drive_.notice(Severity::alarm, "alarm", code, fmt::format("drive {}: {}", drive_.title(), error_text()), t);
    if (drive_.homing.broken()) homing_failed();
    drive_.motion.no_target();
}

void Feedback::track(const Status& s, Instant now) {
    track_.emplace_back(now, s.position);
    while (track_.size() > 2 && now - track_.front().first > std::chrono::milliseconds(100))
        track_.pop_front();
}

void Feedback::publish(Turn& t) {
    if (drive_.axis() == no_axis || !known_ || !placed_) return;
    const Status& s = status_;
    const std::uint8_t main = s.state(), sub = s.sub_state();
    fb_.power = main >= state::enabled ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    fb_.fault = in_error() || kept_;
    fb_.rates = rates();
    fb_.course = drive_.stream.on() ? Course::endless : drive_.motion.course();
    fb_.safe_stop = power_taken(t.now);
    fb_.warning = s.bit(bit::warning);
    fb_.referenced = s.bit(bit::homed);
    fb_.error_code = in_error() ? sub : std::uint16_t{0};
    fb_.internal_limit = fb_.fault && (sub == 0x07 || sub == 0x08 || sub == 0x87 || sub == 0x88);
    fb_.quick_stopping = main == state::aborting || main == state::quick_stop;
    // The drive's state in the coding of CiA 402. Lower states are not shown: they follow from the control word of this gateway, not from
    // that of a client.
    const bool standing_by = main == state::tests || main == state::ready_to_operate;
    fb_.statusword = fb_.quick_stopping       ? std::optional<std::uint16_t>(0x0007)
                     : main >= state::enabled ? std::optional<std::uint16_t>(0x0027)
                     : standing_by            ? std::optional<std::uint16_t>(0x0023)
                                              : std::nullopt;
    judge_motion(t.now);
    fb_.target_reached = drive_.motion.to_target() && !drive_.motion.fresh() && !drive_.jobs.is(drive_.motion) && !fb_.moving &&
                         s.in_target() && main == state::enabled;
    fb_.native_status = std::uint32_t{s.state_var} << 16 | s.status;
    fb_.at = t.now;
    drive_.demand.at_status(fb_, t);
    t.out.feedback.push_back({drive_.axis(), fb_});
}

void Feedback::judge_motion(Instant now) {
    const Status& s = status_;
    const std::uint8_t main = s.state(), sub = s.sub_state();
    fb_.homing = main == state::homing && (sub != finished || drive_.homing.settles(now));
    const bool own_motion = (main == state::homing || main == 10 || main == state::initial || main == 15) && sub != finished;
    const bool braking = main == state::aborting || main == state::freezing || main == state::quick_stop;
    const bool shifts = track_.size() > 1 && std::abs(std::int64_t{track_.back().second} - (track_.end() - 2)->second) > 10;
    fb_.moving = main >= state::enabled && (s.moving() || own_motion || ((main == 16 || main == 17) && sub == 1) || (braking && shifts));
    fb_.position = s.position;
    fb_.velocity = 0;
    if (fb_.moving && track_.size() > 1) {
        const double dt = seconds(track_.back().first - track_.front().first);
        if (dt > 0) fb_.velocity = std::llround((double{1} * track_.back().second - track_.front().second) / dt);
    }
    if (!fb_.moving && track_.size() > 1) track_.erase(track_.begin(), track_.end() - 1);
}

}  // namespace axisgate::linmot
