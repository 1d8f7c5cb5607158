// Verbs, part power: into ONLINE and back, AUTOMATIC, and the way out of errors.
// In: enable, reset and the mode actions; the operating status as it changes. Out: 0603, 0A81, 0602, 0600, 0A41, 0909, 0A97.
// Never fights an operator: what was switched at the control is published, and only a new command switches back.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr Duration change_limit = std::chrono::seconds(10);            // of a change of mode: PAB programs and ramps end first
constexpr Duration switching_limit = std::chrono::milliseconds(1500);  // of an axis that is not on yet when 0A97 has been acknowledged
constexpr int rounds_limit = 4;
constexpr int step_left = 1;     // of an enable: 0A81 was acknowledged
constexpr int step_started = 2;  // 0603 was acknowledged; the operating status of an acknowledgement may be older than that

std::string_view stop_advice(std::uint16_t q) {
    return q == quit::no_external_stop ? "the external-stop input must be defined and carry power before ONLINE starts"
                                       : std::string_view();
}
}  // namespace

void Power::run(Axis& a, const Reply* reply, Turn& t) {
    if (a.job.kind == Job::Kind::enable) return run_enable(a, reply, t);
    a.job.kind == Job::Kind::reset ? run_reset(a, reply, t) : run_mode(a, reply, t);
}

/// False: the job has ended, or asks on.
bool Power::enable_goes_on(Axis& a, const Reply& reply, Turn& t) {
    Job& j = a.job;
    switch (j.request.code) {
        case code::start_online:
            if (reply.quit == 0) {
                drive_.started_by_us = true;
                j.step = step_started;
            }
            // Somebody may have changed the mode in the same moment: then it is decided anew.
            if (reply.quit != quit::no_external_stop && is_online(drive_.mode) && reply.quit != 0 && j.rounds++ < rounds_limit) return true;
            return !jobs_.ended_by_quit(a, reply, t, stop_advice(reply.quit));
        case code::abort_online:
            j.step = step_left;
            return !jobs_.ended_by_quit(a, reply, t);
        case code::stop_axis:
            // Whatever was interrupted counts as finished now; a refusal means that there was nothing.
            if (drive_.mode != status::online || drive_.error != 0) return true;
            jobs_.ask(a, code::axis_on);
            return false;
        case code::axis_on:
            if (reply.quit == quit::not_executable || reply.quit == quit::unknown_command) {
                if (is_online(drive_.mode)) has_no_switch(a, reply.quit, t);
            } else if (jobs_.ended_by_quit(a, reply, t)) {
                return false;
            }
            if (reply.quit == 0) {
                a.no_switch = false;
                a.switching_until = t.now + switching_limit;
            }
            if (drive_.options.release && !a.fb.referenced) {
                jobs_.ask(a, code::no_reference);
                return false;
            }
            if (is_online(drive_.mode)) break;
            jobs_.refuse(a, Reason::wrong_state, drive_.why_not_online(), t);
            return false;
        case code::no_reference:
            if (jobs_.ended_by_quit(a, reply, t)) return false;
            a.fb.referenced = true;
            break;
        default:
            return true;
    }
    a.on = true;
    a.off_ordered = false;
    if (j.rounds > 0) drive_.stops.keep_off();  // by way of home position
    drive_.give_back_due = false;
    feedback_.publish(a, t);
    jobs_.finished(a, t);
    return false;
}

void Power::has_no_switch(Axis& a, std::uint16_t refusal, Turn& t) {
    ++drive_.bus.counters.refused;
    if (std::exchange(a.no_switch, true)) return;
    drive_.notice(Severity::warning, "power", refusal,
                  fmt::format("axis {}: the control does not switch it on or off (0A97: {}): it has power as long as the control gives it; "
                              "a disable stops it and takes no power from it",
                              a.channel, describe_quit(refusal)),
                  t, a.id);
}

/// To ONLINE (if it is not), then 0A9A and 0A97. Nothing moves: a stopped ONLINE is left and begun anew, since 0603 from there would let
/// interrupted motions go on, and so would 0A97 with one of this axis.
void Power::run_enable(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    if (reply && !enable_goes_on(a, *reply, t)) return;
    const int mode = drive_.mode;
    if (j.rounds > rounds_limit) return jobs_.refuse(a, Reason::wrong_state, drive_.why_not_online(), t);
    const bool not_shown =
        (j.step == step_left && is_online(mode)) || (j.step == step_started && mode == status::home && drive_.error == 0);
    if (not_shown) return jobs_.wait(a, j.limit == never ? t.now + change_limit : j.limit);
    j.step = 0;
    if (mode == status::online && drive_.error == 0) {
        if (a.status != 8) return jobs_.ask(a, code::stop_axis);
        return jobs_.refuse(a, Reason::wrong_state, fmt::format("axis {} is in measuring mode: leave it with measure off", a.channel), t);
    }
    if (mode == status::home && drive_.error == 0) {
        if (!drive_.options.online_auto && !drive_.started_by_us)
            return jobs_.refuse(
                a, Reason::wrong_state,
                "the control is in home position and the option online is manual: start ONLINE with the action online.start", t);
        const bool asked = std::ranges::any_of(drive_.axes, [&](const Axis& x) {
            return &x != &a && x.job.active() && x.job.request.code == code::start_online &&
                   (x.job.in_flight || x.job.want == Job::Want::send || x.job.waits());
        });
        if (asked) return jobs_.wait(a, std::min(j.limit, t.now + change_limit));  // another axis is doing it
        ++j.rounds;
        return jobs_.ask(a, code::start_online);
    }
    if (mode == status::online_started || mode == status::online_stop || mode == status::none || mode < 0) {
        j.text = "enable";
        return jobs_.wait(a, std::min(j.limit, t.now + change_limit));
    }
    if (mode == status::online_stopped && drive_.error == 0) {
        ++j.rounds;
        return jobs_.ask(a, code::abort_online);
    }
    jobs_.refuse(a, Reason::wrong_state, drive_.why_not_online(), t);
}

/// False: the job has ended.
bool Power::reset_goes_on(Axis& a, const Reply& reply, Turn& t) {
    Job& j = a.job;
    const std::uint16_t asked = j.request.code;
    if (asked == code::reset_error && reply.quit == quit::not_executable) {
        ++drive_.bus.counters.refused;
        jobs_.over(a, Outcome::failed, Reason::drive_refused,
                   fmt::format("the PA-CONTROL error E{} cannot be reset ({}): remove its cause, then switch the control off and on",
                               reply.data, describe_quit(reply.quit)),
                   t, reply.quit);
        return false;
    }
    if (reply.quit != 0) {
        const bool again = j.rounds < rounds_limit && (asked != code::reset_error || reply.quit == quit::inadmissible);
        return again || !jobs_.ended_by_quit(a, reply, t);
    }
    if (asked == code::abort_online || asked == code::abort_auto) j.step = 1;
    if (asked == code::status_axis) feedback_.learn_status(a, static_cast<int>(number_of(reply).value_or(-1)), t);
    return true;
}

/// Errors of class 3 (500..999) go on the way to home position, those of class 2 by 0909 there [L2770-L2780].
void Power::run_reset(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    if (reply && !reset_goes_on(a, *reply, t)) return;
    const int mode = drive_.mode;
    const bool trouble = drive_.in_trouble();
    if (j.step == 1 && (is_online(mode) || is_automatic(mode))) return jobs_.wait(a, j.limit == never ? t.now + change_limit : j.limit);
    j.step = 0;
    if (mode < 0) return jobs_.wait(a, t.now + change_limit);
    if (!trouble && a.status != 4) {
        a.fb.homing_error = false;
        if (j.rounds > 0) drive_.stops.keep_off();
        feedback_.publish_all(t);
        return jobs_.finished(a, t);
    }
    if (j.rounds++ > rounds_limit)
        return jobs_.over(
            a, Outcome::failed, Reason::drive_refused,
            fmt::format("the fault is still there: {}, PA-CONTROL error E{}, axis status {}", drive_.mode_text(), drive_.error, a.status),
            t, drive_.error);
    if (is_manual(mode)) return jobs_.refuse(a, Reason::wrong_state, drive_.why_not_online(), t);
    if (is_online(mode)) return jobs_.ask(a, code::abort_online);
    if (is_automatic(mode)) return jobs_.ask(a, code::abort_auto);
    // Home position. An axis that shows a malfunction without an error is looked at again.
    jobs_.ask(a, trouble ? code::reset_error : code::status_axis);
}

void Power::start_mode(Axis& a, std::uint16_t what, Turn& t) {
    a.job.kind = Job::Kind::mode;
    a.job.verb = this;
    a.job.step = what;
    run_mode(a, nullptr, t);
}

bool Power::is_there(std::uint16_t what) const noexcept {
    const int mode = drive_.mode;
    return what == code::start_online   ? mode == status::online
           : what == code::abort_online ? !is_online(mode)
           : what == code::abort_auto   ? !is_automatic(mode)
           : what == code::start_auto   ? mode == status::auto_run
                                        : mode == status::auto_stopped || mode == status::online_stopped || is_home(mode);
}

void Power::run_mode(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const auto what = static_cast<std::uint16_t>(j.step);
    if (!reply && j.rounds == 0) {
        if (is_there(what) && what != code::stop)
            return jobs_.over(a, Outcome::done, Reason::none, fmt::format("operating status is {} already", status_text(drive_.mode)), t);
        ++j.rounds;
        return jobs_.ask(a, what);
    }
    if (reply) {
        if (jobs_.ended_by_quit(a, *reply, t, stop_advice(reply->quit))) return;
        if (what == code::start_online) drive_.started_by_us = false;  // started by hand: given back by hand
        if (!j.command.until_done) return jobs_.over(a, Outcome::accepted, Reason::none, drive_.mode_text(), t);
    }
    if (is_there(what)) return jobs_.over(a, Outcome::done, Reason::none, drive_.mode_text(), t);
    jobs_.wait(a, j.limit == never ? t.now + change_limit : j.limit);
}

/// The last axis is off: a control that this gateway brought into ONLINE goes back to home position, where parameters can be read, unless
/// an axis would have power there.
void Power::consider_give_back(Turn& t) {
    // A parameter that waits for home position is a reason to go there, not one to stay; what stands behind it in the queue waits with it.
    const auto waits_for_home = [](const Axis& a) { return a.job.of_parameter() && a.job.waits(); };
    if (!(drive_.give_back_due || std::ranges::any_of(drive_.axes, waits_for_home)) || !drive_.started_by_us ||
        !drive_.options.give_back_auto || drive_.leaving || drive_.port.busy())
        return;
    if (drive_.mode != status::online && drive_.mode != status::online_stopped) return;
    // Neither a disable nor a parameter that waits is an order to give power to an axis of enable mode 1.
    for (const Axis& a : drive_.axes) {
        if (drive_.powered_at_home(a) || a.on || a.moves()) return;
        if (!waits_for_home(a) && (a.job.active() || !a.queue.empty())) return;
    }
    drive_.give_back_due = false;
    drive_.leaving = true;
    drive_.port.send({Purpose::give_back, 0, request_for(code::abort_online)}, Priority::command, t);
}

}  // namespace axisgate::pacontrol
