// Feedback: status, error, running axes, positions and axis statuses as they are received.
// In: acknowledgements. Out: an axis' feedback as a whole, what changed for everybody, exactly one end per motion.
// A motion has not ended before its axis' status and position were read behind it.
#include "adapters/pacontrol/feedback.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "adapters/pacontrol/wire_number.hpp"

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr Duration begin_limit = std::chrono::milliseconds(1500);  // from an acknowledged motion to the status that shows it
constexpr Duration place_limit = std::chrono::milliseconds(700);   // from the status of an axis at rest to its last position

/// How far from its target an axis in position may be: 7 digits, and the step of a gear.
std::int64_t slack_of(const Motion& m) { return std::max<std::int64_t>(50, std::llabs(m.target) / 100'000); }
}  // namespace

/// Where an axis is shown, its fault is the alarm; the control's own word is one only where there is none to say it.
bool Feedback::shown_by_axes() const {
    return drive_.ready() && std::ranges::any_of(drive_.axes, [](const Axis& a) { return a.used() && a.position_known; });
}

void Feedback::ask_whose_fault(Turn& t) {
    drive_.trouble_at = t.now;
    for (auto a = drive_.axes.rbegin(); a != drive_.axes.rend(); ++a) {
        if (a->here()) drive_.polls.soon(a->status_code(), *a);
    }
}

void Feedback::learn(const Reply& reply, Turn& t) {
    const int before = drive_.mode;
    const bool error_changed = drive_.error != reply.error, was_in_trouble = drive_.in_trouble();
    drive_.mode = reply.status;
    drive_.error = reply.error;
    if (drive_.in_trouble() && (!was_in_trouble || (error_changed && drive_.error != 0))) ask_whose_fault(t);
    if (error_changed) {
        if (drive_.error != 0) {
            drive_.notice(shown_by_axes() ? Severity::info : Severity::alarm, "alarm", drive_.error, drive_.error_text(), t);
        } else {
            drive_.notice(Severity::info, "alarm", 0, "no PA-CONTROL error any more", t);
        }
        drive_.wake = true;
    }
    if (before != drive_.mode) mode_changed(before, t);
    if (error_changed || before != drive_.mode) publish_all(t);
}

void Feedback::mode_changed(int before, Turn& t) {
    drive_.wake = true;
    drive_.polls.hurry(t.now);
    if (before < 0) return;  // just found
    if (is_online(before) && !is_online(drive_.mode)) return left_online(before, t);
    if (is_home(drive_.mode) && !is_home(before)) drive_.demands.parameters_may_have_changed();
    if (is_malfunction(drive_.mode) && !is_malfunction(before)) {
        drive_.notice(shown_by_axes() ? Severity::info : Severity::alarm, "mode", drive_.mode,
                      fmt::format("operating status is now {}", status_text(drive_.mode)), t);
    } else if (drive_.mode == status::online_stop || (drive_.mode == status::online_stopped && before == status::online)) {
        const std::string text =
            fmt::format("operating status is now {}: stopped at the control or by its stop input", status_text(drive_.mode));
        drive_.notice(Severity::warning, "mode", drive_.mode, text, t);
        for (Axis& a : drive_.axes) {
            if (a.motion.active()) end_motion(a, false, Reason::interrupted, text, t);
        }
    } else if (is_manual(drive_.mode) || is_automatic(drive_.mode) || is_home(drive_.mode)) {
        if (is_manual(drive_.mode) != is_manual(before) || is_automatic(drive_.mode) != is_automatic(before)) {
            drive_.notice(Severity::info, "mode", drive_.mode, fmt::format("operating status is now {}", status_text(drive_.mode)), t);
        }
    }
}

/// ONLINE has ended: overrides are dropped [L3496], commanded motions are over [L3253], and no axis is on for the gateway.
void Feedback::left_online(int before, Turn& t) {
    const bool expected = drive_.leaving;
    const std::string text = fmt::format("operating status changed from {} to {}{}", status_text(before), status_text(drive_.mode),
                                         expected ? "" : ", not by this gateway: switched at the control, or by an error");
    bool any = false;
    for (Axis& a : drive_.axes) {
        any = any || a.on;
        if (a.motion.active()) end_motion(a, false, Reason::interrupted, text, t);
        end_waits(a, Reason::interrupted, text, t);
        a.on = a.prepared = a.condition_set = false;
        a.speed.reset();
        a.acceleration.reset();
        a.renewal.stop();
    }
    if (!expected || is_malfunction(drive_.mode)) {
        drive_.notice(any ? Severity::warning : Severity::info, "mode", drive_.mode, text, t);
    }
    drive_.started_by_us = drive_.leaving = drive_.give_back_due = false;
}

// --- axes ------------------------------------------------------------------------------------------------------------------------

void Feedback::derive(Axis& a, Instant now) {
    AxisFeedback& f = a.fb;
    f.power = drive_.mode < 0                  ? AxisFeedback::Power::unknown
              : a.on && is_online(drive_.mode) ? AxisFeedback::Power::on
                                               : AxisFeedback::Power::off;
    f.fault = a.status == 4 || drive_.fault_of_all(now);
    // The error's number goes before the status of the axis is read anew: until then it is the same fault, not one without a number.
    if (drive_.error != 0) a.trouble = drive_.error;
    if (!f.fault) a.trouble = 0;
    f.error_code = a.trouble;
    f.moving = a.moves();
    if (f.moving) a.reached = false;
    if (!f.moving) f.velocity = 0;  // it stands: 1910 or 1911 shows it
    f.internal_limit = a.limits >= 0 && (a.limits & 6) != 6;
    // Stopped by the control: by its stop input, by a key, by the malfunction of another axis. Only enable, or a reset there, ends it.
    f.quick_stopping = a.on && !f.fault && is_online(drive_.mode) && drive_.mode != status::online && drive_.mode != status::online_started;
    f.rates = Demands::rates(a);
    // A velocity move is one to the end of the traverse area; what others have begun the control does not tell.
    f.course = a.motion.kind == Motion::Kind::velocity   ? Course::endless
               : a.motion.kind == Motion::Kind::position ? Course::to_target
               : a.motion.kind == Motion::Kind::manual   ? Course::to_target
                                                         : Course::unknown;
    f.safe_stop = a.power_lost || drive_.mode == status::online_stop;
    f.warning = (a.limits >= 0 && a.on && !(a.limits & 1)) || (drive_.in_trouble() && !f.fault);
    drive_.demands.show(a, now);
    // The control calls it in position by its counter alone; whoever reads the flag means the shaft.
    const bool behind = !f.moving && Demands::stands_behind(a);
    f.target_reached = a.reached && !behind;
    f.warning = f.warning || behind;
    const int status = a.status < 0 && a.running ? 1 : a.status;  // 1911 says as much as 1910 of an axis that moves
    f.native_status = static_cast<std::uint32_t>(drive_.mode & 0xFF) | static_cast<std::uint32_t>(status & 0xFF) << 8 |
                      static_cast<std::uint32_t>(a.limits & 0xFF) << 16;
    // As old as the oldest of what is published together. The switches of an axis that moves are looked at in turn, and are not counted.
    f.at = a.demand.shown_at;
    for (const Instant part : {a.running_at, f.moving ? a.velocity_at : a.status_at}) {
        if (part != Instant{}) f.at = std::min(f.at, part);  // what was not received since the drive answers is not shown either
    }
}

void Feedback::publish(Axis& a, Turn& t) {
    if (!a.used() || !a.position_known || !drive_.ready()) return;
    derive(a, t.now);
    t.out.feedback.push_back({a.id, a.fb});
    check_waits(a, t);
}

void Feedback::publish_all(Turn& t) {
    for (Axis& a : drive_.axes)
        publish(a, t);
}

void Feedback::learn_position(Axis& a, double units, Turn& t) {
    a.counter = increments_of(units);
    a.counter_at = t.now;
    a.demand.fresh = true;
    if (a.demand.stands && a.demand.settle && !a.moves()) drive_.demands.rest(a, a.counter);
    const bool first = !a.position_known;
    a.position_known = true;
    if (first && !a.lost.empty()) {
        drive_.notice(Severity::warning, "motion", 0, fmt::format("{}; the position read back is {}", a.lost, axis_text(a.counter)), t,
                      a.id);
        a.lost.clear();
    }
    publish(a, t);
}

void Feedback::learn_running(std::uint32_t mask, Turn& t) {
    for (Axis& a : drive_.axes) {
        if (!a.here()) continue;
        const bool was = a.running;
        a.running = mask >> (a.channel - 1) & 1u;
        a.running_at = t.now;
        if (!a.running) a.velocity_at = t.now;
        const bool motion_seen = a.motion.active() && a.motion.kind != Motion::Kind::reference;
        if (a.running != was) drive_.wake = true;
        if (a.running) {
            a.motion.final_due = false;
            a.motion.seen_running = true;
            drive_.demands.seen_running(a, t.now);
        } else if (motion_seen && a.motion.begun < drive_.exchanges && !a.motion.final_due) {
            // It stands, and was asked after the motion had begun. Status and position first, then its end is published.
            a.motion.final_due = true;
            a.motion.stood_at = t.now;
            if (a.status != 4) a.status = -1;  // a malfunction that has been read meanwhile is the newest there is
            drive_.polls.soon_standing(a);
            drive_.polls.soon(a.status_code(), a);
        } else if (was && !motion_seen) {
            drive_.polls.soon_standing(a);
        }
        if (!a.running) drive_.demands.seen_standing(a);
        publish(a, t);
    }
}

void Feedback::learn_status(Axis& a, int s, Turn& t) {
    a.status = s;
    a.status_at = t.now;
    if (s == 1) {
        a.running = true;
        a.motion.final_due = false;
        a.motion.seen_running = true;
    }
    if (s == 4 && !a.malfunction_published) {
        // The fault that follows from it is the alarm.
        drive_.notice(Severity::info, "axis", 4, fmt::format("axis {}: axis status 4, malfunction", a.channel), t, a.id);
        drive_.wake = true;
    }
    a.malfunction_published = s == 4;
}

// --- polls -----------------------------------------------------------------------------------------------------------------------

void Feedback::poll_answered(const Poll& p, const Reply& reply, Turn& t) {
    Axis& a = drive_.axes[p.axis];
    // Not yet. Models without a following error refuse it with the same number, and it is asked once.
    const bool busy = reply.quit == quit::not_executable && t.now < drive_.busy_until && p.code != code::following_error;
    if (reply.quit == quit::not_initialised || busy) return;
    if (p.code == code::axis_parameter) drive_.demands.parameter_answered(a, p.parameter, reply, t.now);
    if (reply.quit != 0) return poll_refused(a, p, reply, t);
    int before = -1;
    const double v = number_of(reply).value_or(0);
    const auto n = std::fabs(v) < 4e9 ? static_cast<std::uint32_t>(std::llround(std::fabs(v))) : 0u;
    switch (p.code) {
        case code::running_axes:
            return learn_running(n, t);
        case code::speed:
            return learn_speed(a, v, t);
        case code::system_flag:
            a.fb.referenced = n != 0;
            return;
        case code::status_axis:
            return learn_status(a, static_cast<int>(n), t);
        case code::extended_status:
            // Byte 0, the highest: power pack ready; 1 positive and 2 negative limit switch (1: free); 3 axis status [L3164-L3194].
            before = a.limits;
            a.limits = static_cast<int>((n >> 24 & 1u) | (n >> 16 & 1u) << 1 | (n >> 8 & 1u) << 2);
            watch_power(a, before, t);
            return learn_status(a, static_cast<int>(n & 0xFFu), t);
        case code::following_error:
            drive_.demands.following_answered(a, v, t.now);
            if (!a.running) publish(a, t);  // of one that runs the position is asked next: they are published together
            return;
        case code::position:
            return a.motion.final_due && a.status >= 0 && a.status != 1 ? learn_end(a, v, t) : learn_position(a, v, t);
        default:
            return;
    }
}

/// The power pack of an axis that is on is not ready any more: the axis is switched off here, or it would be powered again with its pack.
void Feedback::watch_power(Axis& a, int before, Turn& t) {
    if ((a.limits & 1) != 0) a.power_lost = false;
    if (before < 0 || (before & 1) == 0 || (a.limits & 1) != 0 || !a.on) return;
    a.power_lost = true;
    if (drive_.mode != status::online || drive_.error != 0) return;  // the way out of a malfunction switches all axes off
    drive_.stops.add(Stops::Kind::off, a);
    drive_.notice(
        Severity::warning, "power", 0,
        fmt::format("axis {}: its power pack is not ready any more: it is switched off; enable it again when that is over", a.channel), t,
        a.id);
}

void Feedback::poll_refused(Axis& a, const Poll& p, const Reply& reply, Turn& t) {
    ++drive_.bus.counters.refused;
    if (p.code == code::following_error) drive_.demands.following_refused(a, reply);
    if (reply.quit == quit::axis_unknown && !a.missing) {
        a.missing = true;
        drive_.notice(Severity::alarm, "setup", reply.quit,
                      fmt::format("the control has no axis {} ({}): take it out of the site, or raise system parameter 2 (number of axes)",
                                  a.channel, describe_quit(reply.quit)),
                      t, a.id);
    } else if (reply.quit != quit::inadmissible) {
        if (p.code == code::extended_status) a.extended_missing = true;
        if (p.code == code::status_axis) a.status_at = t.now;  // asked, and it does not say
        if (p.code == code::system_flag) drive_.system_flags_missing = true;
    }
}

void Feedback::learn_speed(Axis& a, double units, Turn& t) {
    a.fb.velocity = increments_of(units);
    a.velocity_at = t.now;
    if (a.motion.kind == Motion::Kind::velocity || a.motion.kind == Motion::Kind::position) {
        // Whether the control gives the speed a sign is not said [L2885]: the direction of a commanded motion is known.
        const bool down = a.motion.kind == Motion::Kind::velocity ? a.motion.target < 0 : a.motion.target < a.counter;
        a.fb.velocity = down ? -std::llabs(a.fb.velocity) : std::llabs(a.fb.velocity);
    }
    publish(a, t);
}

/// The axis is shown at rest away from its target: the control may show the beginning of a motion, or its last position, only later.
bool Feedback::shown_late(const Axis& a, std::int64_t position, Instant now) const {
    const Motion& m = a.motion;
    if ((a.status != 0 && a.status != 2) || m.kind == Motion::Kind::reference) return false;
    if (m.kind != Motion::Kind::velocity && std::llabs(position - m.target) <= slack_of(m)) return false;
    const bool plain = m.kind == Motion::Kind::position && !m.conditional;
    if (now < m.begun_at + begin_limit && (plain || !m.seen_running)) return true;
    return plain && a.status == 0 && now < m.stood_at + place_limit;
}

/// The position at which a motion has ended, and how it has.
void Feedback::learn_end(Axis& a, double units, Turn& t) {
    const std::int64_t position = increments_of(units);
    if (shown_late(a, position, t.now)) return learn_position(a, units, t);
    const Motion m = a.motion;
    std::string why;
    bool reached = m.kind == Motion::Kind::position || m.kind == Motion::Kind::manual;
    const std::string cause = drive_.what_ended(a);
    const std::int64_t slack = slack_of(m);
    if (a.status == 4) {
        reached = false;
        why = "axis status 4, malfunction" + (cause.empty() ? cause : ": " + cause);
    } else if (a.status == 2) {
        reached = false;
        why = "axis status 2, stopped" + (cause.empty() ? cause : ": " + cause);
    } else if (a.status == 8) {
        reached = false;
        why = "axis status 8, measuring mode";
    } else if (m.kind == Motion::Kind::velocity) {
        why = "the end of the traverse area is reached";
    } else if ((m.conditional || m.kind == Motion::Kind::manual) && std::llabs(position - m.target) > slack) {
        reached = false;
        why = m.conditional ? "the condition has ended it" : "the manual move was not renewed in time, or was stopped";
    }
    a.counter = position;
    a.counter_at = t.now;
    a.demand.fresh = true;
    a.running = false;
    drive_.demands.rest(a, reached && m.kind == Motion::Kind::position ? m.target : position);
    end_motion(a, reached, a.status == 4 && drive_.error != 0 ? Reason::drive_refused : Reason::interrupted,
               fmt::format("axis {} has stopped at {}, target {}: {}", a.channel, axis_text(position), axis_text(m.target), why), t);
    if (reached && Demands::stands_behind(a))
        drive_.notice(Severity::warning, "motion", a.status,
                      fmt::format("axis {}: in position by its counter, but the shaft is {} behind: it is held or has lost steps",
                                  a.channel, axis_text(Demands::following_error(a))),
                      t, a.id);
    if (!reached)
        drive_.notice(Severity::info, "motion", a.status, fmt::format("axis {}: {}, at {}", a.channel, why, axis_text(position)), t, a.id);
}

void Feedback::begin_motion(Axis& a, Motion motion, Turn& t) {
    a.motion = motion;
    a.motion.begun = drive_.exchanges;
    a.motion.begun_at = t.now;
    if (!a.running) a.velocity_at = t.now;  // it stood until then
    a.running = true;
    a.running_at = t.now;
    a.status = -1;
    a.reached = a.fb.homing_attained = false;
    a.fb.homing_error = false;
    drive_.polls.hurry(t.now);
    publish(a, t);
}

void Feedback::end_motion(Axis& a, bool reached, Reason reason, const std::string& text, Turn& t) {
    const Motion was = a.motion;
    a.motion = {};
    a.renewal.stop();
    a.condition_set = false;
    drive_.wake = true;
    if (reached) a.running = false;
    a.reached = reached;
    if (was.kind == Motion::Kind::reference) {
        a.fb.homing_attained = reached;
        a.fb.homing_error = !reached && reason != Reason::interrupted;
        if (reached) a.fb.referenced = true;
    }
    if (!reached) end_waits(a, reason, text, t);
    publish(a, t);
}

// --- waits -----------------------------------------------------------------------------------------------------------------------

void Feedback::accepted(Axis& a, const Command& c, Wait::For what, std::int64_t value, std::string text, Turn& t) {
    if (!c.until_done || c.ticket == no_ticket || a.waits.size() >= Axis::wait_limit) {
        drive_.tickets.accepted(c.ticket, t.out, std::move(text));
        return;
    }
    a.waits.push_back({what, c.ticket, value});
    check_waits(a, t);
}

void Feedback::check_waits(Axis& a, Turn& t) {
    std::erase_if(a.waits, [&](const Wait& w) {
        const AxisFeedback& f = a.fb;
        const bool done = w.what == Wait::For::speed    ? std::llabs(f.velocity - w.value) * 100 <= std::llabs(w.value)
                          : w.what == Wait::For::target ? a.reached && !f.moving
                                                        : !f.moving;
        if (done) drive_.tickets.answer(w.ticket, Outcome::done, Reason::none, "", t.out);
        return done;
    });
}

void Feedback::end_waits(Axis& a, Reason reason, const std::string& text, Turn& t, bool motions_only) {
    std::erase_if(a.waits, [&](const Wait& w) {
        if (motions_only && w.what == Wait::For::standstill) return false;
        drive_.tickets.failed(w.ticket, reason, text, t.out, drive_.error);
        return true;
    });
}

}  // namespace axisgate::pacontrol
