// Drive, part status: what the control says of itself and of its axes, and what follows from it.
// In: acknowledgements. Out: feedback, notices, the ends of motions and of waits.
// Never mixes three different things: the command error (QUIT, of one command), the operating status, and the PA-CONTROL error (Exxx).
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr Duration judge_limit = std::chrono::seconds(2);  // for all statuses to be read: sixteen at 9600 baud take 0.7 s
}

void Drive::result(Axis& a, Ticket ticket, Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code, Value value,
                   std::vector<std::uint8_t> bytes) {
    if (ticket == no_ticket) return;
    t.out.results.push_back({ticket, a.id, outcome, reason, code, std::move(text), std::move(value), std::move(bytes)});
}

void Drive::notice(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t, AxisId axis) {
    notices_.tell(severity, axis, kind, code, std::move(text), t.now, t.out);
}

void Drive::sample(const Axis& a, Point point, const Value& value, Turn& t) {
    const Binding* b = elements_.binding(point);
    if (!b || !known(value)) return;
    if (!b->drive) {
        t.out.samples.push_back({a.id, point, value, Quality::good, t.now});
        return;
    }
    for (const Axis& x : axes_) {  // same point, same value, whichever axis one looks through
        if (x.id != no_axis) t.out.samples.push_back({x.id, point, value, Quality::good, t.now});
    }
}

/// Where an axis is shown, its fault is the alarm; the control's own word is one only where there is none to say it.
bool Drive::shown_by_axes() const {
    return presence_.is(Phase::ready) && std::ranges::any_of(axes_, [](const Axis& a) { return a.id != no_axis && a.position_known; });
}

bool Drive::in_trouble() const noexcept { return error_ != 0 || is_malfunction(mode_); }

const Axis* Drive::culprit() const noexcept {
    const auto it = std::ranges::find_if(axes_, [](const Axis& a) { return a.id != no_axis && a.status == 4; });
    return it == axes_.end() ? nullptr : &*it;
}

/// STATUS and ERROR do not say whose trouble it is: the axes' own statuses do. Nobody's is everybody's: then none can move.
bool Drive::fault_of_all(Instant now) const noexcept {
    if (!in_trouble() || culprit()) return false;
    std::size_t here = 0;
    bool read = true;
    for (const Axis& a : axes_) {
        if (a.id == no_axis || a.missing) continue;
        ++here;
        read = read && a.status >= 0 && a.status_at >= trouble_at_;
    }
    return here <= 1 || read || now - trouble_at_ > judge_limit;
}

void Drive::ask_whose_fault(Turn& t) {
    trouble_at_ = t.now;
    for (auto a = axes_.rbegin(); a != axes_.rend(); ++a) {
        if (a->id != no_axis && !a->missing) poll_soon(status_poll(*a), *a);
    }
}

std::string Drive::error_text() const {
    const ErrorCode* of_catalogue = catalogue_.error(error_, "system");
    return fmt::format("PA-CONTROL error E{}{}{}", error_, of_catalogue ? ": " : "", of_catalogue ? of_catalogue->text : "");
}

std::string Drive::what_ended(const Axis& a) const {
    const std::string now = fmt::format("operating status {}", status_text(mode_));
    if (in_trouble()) {
        const Axis* whose = culprit();
        return fmt::format("{}{}{}", error_ != 0 ? error_text() + "; " : std::string(), now,
                           whose && whose != &a ? fmt::format("; it is axis {} that has the malfunction", whose->channel) : std::string());
    }
    if (mode_ == status::online_stop || mode_ == status::online_stopped) return "stopped at the control or by its stop input; " + now;
    if (!is_online(mode_)) return "ONLINE has ended; " + now;
    return {};
}

/// STATUS and ERROR of any acknowledgement.
void Drive::learn(const Reply& reply, Turn& t) {
    const int before = mode_;
    const bool error_changed = error_ != reply.error, was_in_trouble = in_trouble();
    mode_ = reply.status;
    mode_at_ = t.now;
    error_ = reply.error;
    if (in_trouble() && (!was_in_trouble || (error_changed && error_ != 0))) ask_whose_fault(t);
    if (error_changed) {
        if (error_ != 0) {
            notice(shown_by_axes() ? Severity::info : Severity::alarm, "alarm", error_, error_text(), t);
        } else {
            notice(Severity::info, "alarm", 0, "no PA-CONTROL error any more", t);
        }
        wake_ = true;
    }
    if (before != mode_) mode_changed(before, t);
    if (error_changed || before != mode_) emit_all(t);
}

void Drive::mode_changed(int before, Turn& t) {
    wake_ = true;
    cycle_at_ = std::min(cycle_at_, t.now);
    if (before < 0) return;  // just found
    if (is_online(before) && !is_online(mode_)) return left_online(before, t);
    if (is_home(mode_) && !is_home(before)) parameters_may_have_changed();
    if (is_malfunction(mode_) && !is_malfunction(before)) {
        notice(shown_by_axes() ? Severity::info : Severity::alarm, "mode", mode_,
               fmt::format("operating status is now {}", status_text(mode_)), t);
    } else if (mode_ == status::online_stop || (mode_ == status::online_stopped && before == status::online)) {
        const std::string text = fmt::format("operating status is now {}: stopped at the control or by its stop input", status_text(mode_));
        notice(Severity::warning, "mode", mode_, text, t);
        for (Axis& a : axes_) {
            if (a.motion.active()) end_motion(a, false, Reason::interrupted, text, t);
        }
    } else if (is_manual(mode_) || is_automatic(mode_) || is_home(mode_)) {
        if (is_manual(mode_) != is_manual(before) || is_automatic(mode_) != is_automatic(before)) {
            notice(Severity::info, "mode", mode_, fmt::format("operating status is now {}", status_text(mode_)), t);
        }
    }
}

/// ONLINE has ended: overrides are dropped [L3496], commanded motions are over [L3253], and no axis is on for the gateway.
void Drive::left_online(int before, Turn& t) {
    const bool expected = leaving_;
    const std::string text = fmt::format("operating status changed from {} to {}{}", status_text(before), status_text(mode_),
                                         expected ? "" : ", not by this gateway: switched at the control, or by an error");
    bool any = false;
    for (Axis& a : axes_) {
        any = any || a.on;
        if (a.motion.active()) end_motion(a, false, Reason::interrupted, text, t);
        end_waits(a, Reason::interrupted, text, t);
        a.on = a.prepared = a.condition_set = false;
        a.speed.reset();
        a.acceleration.reset();
        a.renew_at = never;
    }
    if (!expected || is_malfunction(mode_)) {
        notice(any ? Severity::warning : Severity::info, "mode", mode_, text, t);
    }
    started_by_us_ = leaving_ = give_back_due_ = false;
}

// --- axes ------------------------------------------------------------------------------------------------------------------------

void Drive::derive(Axis& a, Instant now) {
    AxisFeedback& f = a.fb;
    f.power = mode_ < 0 ? AxisFeedback::Power::unknown : a.on && is_online(mode_) ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    f.fault = a.status == 4 || fault_of_all(now);
    // The error's number goes before the status of the axis is read anew: until then it is the same fault, not one without a number.
    if (error_ != 0) a.trouble = error_;
    if (!f.fault) a.trouble = 0;
    f.error_code = a.trouble;
    f.moving = a.running || a.motion.active();
    if (f.moving) a.reached = false;
    if (!f.moving) f.velocity = 0;  // it stands: 1910 or 1911 has said so
    f.internal_limit = a.limits >= 0 && (a.limits & 6) != 6;
    // Stopped by the control: by its stop input, by a key, by the malfunction of another axis. Only enable, or a reset there, ends it.
    f.quick_stopping = a.on && !f.fault && is_online(mode_) && mode_ != status::online && mode_ != status::online_started;
    f.warning = (a.limits >= 0 && a.on && !(a.limits & 1)) || (in_trouble() && !f.fault);
    show_demand(a, now);
    // The control calls it in position by its counter alone; whoever reads the flag means the shaft.
    const bool behind = !f.moving && stands_behind(a);
    f.target_reached = a.reached && !behind;
    f.warning = f.warning || behind;
    const int status = a.status < 0 && a.running ? 1 : a.status;  // 1911 says as much as 1910 of an axis that moves
    f.native_status = static_cast<std::uint32_t>(mode_ & 0xFF) | static_cast<std::uint32_t>(status & 0xFF) << 8 |
                      static_cast<std::uint32_t>(a.limits & 0xFF) << 16;
    // As old as the oldest of what is told together. The switches of an axis that moves are looked at in turn, and are not counted.
    f.at = a.aim.shown_at;
    for (const Instant part : {a.running_at, f.moving ? a.velocity_at : a.status_at}) {
        if (part != Instant{}) f.at = std::min(f.at, part);  // what was not told since the drive answers is not shown either
    }
}

void Drive::emit(Axis& a, Turn& t) {
    if (a.id == no_axis || !a.position_known || !presence_.is(Phase::ready)) return;
    derive(a, t.now);
    t.out.feedback.push_back({a.id, a.fb});
    check_waits(a, t);
}

void Drive::emit_all(Turn& t) {
    for (Axis& a : axes_)
        emit(a, t);
}

void Drive::learn_position(Axis& a, double units, Turn& t) {
    a.counter = increments_of(units);
    a.counter_at = t.now;
    a.aim.fresh = true;
    if (a.aim.stands && a.aim.settle && !a.running && !a.motion.active()) rest(a, a.counter);
    const bool first = !a.position_known;
    a.position_known = true;
    if (first && !a.lost.empty()) {
        notice(Severity::warning, "motion", 0, fmt::format("{}; the position read back is {}", a.lost, axis_text(a.counter)), t, a.id);
        a.lost.clear();
    }
    emit(a, t);
}

void Drive::learn_running(std::uint32_t mask, Turn& t) {
    for (Axis& a : axes_) {
        if (a.id == no_axis || a.missing) continue;
        const bool was = a.running;
        a.running = mask >> (a.channel - 1) & 1u;
        a.running_at = t.now;
        if (!a.running) a.velocity_at = t.now;
        const bool motion_seen = a.motion.active() && a.motion.kind != Motion::Kind::reference;
        if (a.running != was) wake_ = true;
        if (a.running) {
            a.motion.final_due = false;
            seen_running(a, t);
        } else if (motion_seen && a.motion.begun < exchanges_ && !a.motion.final_due) {
            // It stands, and was asked after the motion had begun. Status and position first, then everybody hears of its end.
            a.motion.final_due = true;
            if (a.status != 4) a.status = -1;  // a malfunction that has been read meanwhile is the newest there is
            poll_standing(a);
            poll_soon(status_poll(a), a);
        } else if (was && !motion_seen) {
            poll_standing(a);
        }
        if (!a.running) seen_standing(a);
        emit(a, t);
    }
}

void Drive::learn_status(Axis& a, int s, Turn& t) {
    a.status = s;
    a.status_at = t.now;
    if (s == 1) {
        a.running = true;
        a.motion.final_due = false;
    }
    if (s == 4 && !a.malfunction_told) {
        // The fault that follows from it is the alarm.
        notice(Severity::info, "axis", 4, fmt::format("axis {}: axis status 4, malfunction", a.channel), t, a.id);
        wake_ = true;
    }
    a.malfunction_told = s == 4;
}

void Drive::begin_motion(Axis& a, Motion motion, Turn& t) {
    a.motion = motion;
    a.motion.begun = exchanges_;
    if (!a.running) a.velocity_at = t.now;  // it stood until then
    a.running = true;
    a.running_at = t.now;
    a.status = -1;
    a.reached = a.fb.homing_attained = false;
    a.fb.homing_error = false;
    cycle_at_ = std::min(cycle_at_, t.now);
    emit(a, t);
}

/// The motion is over, reached or not. The position must have been read before.
void Drive::end_motion(Axis& a, bool reached, Reason reason, const std::string& text, Turn& t) {
    const Motion was = a.motion;
    a.motion = {};
    a.renew_at = never;
    a.condition_set = false;
    wake_ = true;
    if (reached) a.running = false;
    a.reached = reached;
    if (was.kind == Motion::Kind::reference) {
        a.fb.homing_attained = reached;
        a.fb.homing_error = !reached && reason != Reason::interrupted;
        if (reached) a.fb.referenced = a.referenced_own = true;
    }
    if (!reached) end_waits(a, reason, text, t);
    emit(a, t);
}

// --- waits -----------------------------------------------------------------------------------------------------------------------

void Drive::add_wait(Axis& a, Wait w) { a.waits.push_back(w); }

void Drive::accepted(Axis& a, const Command& c, Wait::For what, std::int64_t value, std::string text, Turn& t) {
    if (c.ticket == no_ticket) return;
    if (!c.until_done || a.waits.size() >= Axis::wait_limit) {
        return result(a, c.ticket, Outcome::accepted, Reason::none, std::move(text), t);
    }
    add_wait(a, {what, c.ticket, value});
    check_waits(a, t);
}

void Drive::check_waits(Axis& a, Turn& t) {
    for (std::size_t i = 0; i < a.waits.size();) {
        const Wait w = a.waits[i];
        const AxisFeedback& f = a.fb;
        bool done = false;
        switch (w.what) {
            case Wait::For::target:
                done = a.reached && !f.moving;
                break;
            case Wait::For::standstill:
                done = !f.moving;
                break;
            case Wait::For::speed:
                done = std::llabs(f.velocity - w.value) * 100 <= std::llabs(w.value);
                break;
        }
        if (!done) {
            ++i;
            continue;
        }
        a.waits.erase(a.waits.begin() + static_cast<std::ptrdiff_t>(i));
        result(a, w.ticket, Outcome::done, Reason::none, "", t);
    }
}

void Drive::end_waits(Axis& a, Reason reason, const std::string& text, Turn& t, bool motions_only) {
    auto waits = std::move(a.waits);
    a.waits.clear();
    for (const Wait& w : waits) {
        if (motions_only && w.what == Wait::For::standstill) {
            a.waits.push_back(w);
        } else {
            result(a, w.ticket, Outcome::failed, reason, text, t, error_);
        }
    }
}

}  // namespace axisgate::pacontrol
