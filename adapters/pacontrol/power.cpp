// Drive, part mode: into ONLINE and back, AUTOMATIC, and the way out of errors.
// In: enable, reset and the mode actions; the operating status as it changes. Out: 0603, 0A81, 0602, 0600, 0A41, 0909, 0A97.
// Never fights an operator: what was switched at the control is told, and only a new command switches back.
#include <fmt/core.h>

#include <algorithm>

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr Duration change_limit = std::chrono::seconds(10);  // of a change of mode: PAB programs and ramps end first
constexpr int rounds_limit = 4;
}  // namespace

std::string Drive::why_not_online() const {
    if (is_manual(mode_))
        return fmt::format("operating status {}: an operator has the control; leave manual mode there", status_text(mode_));
    if (is_automatic(mode_))
        return fmt::format("operating status {}: a program has the axes; automatic.cancel ends it", status_text(mode_));
    if (in_trouble()) {
        const Axis* whose = culprit();
        return fmt::format("operating status {}, {}: reset the fault{} first", status_text(mode_), error_text(),
                           whose ? fmt::format(" of axis {}", whose->channel) : std::string());
    }
    return fmt::format("operating status {}", status_text(mode_));
}

/// To ONLINE (if it is not), then 0A9A and 0A97. Nothing moves: a stopped ONLINE is left and begun anew, since 0603 from there would let
/// interrupted motions go on, and so would 0A97 with one of this axis.
void Drive::run_enable(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const auto ch = static_cast<std::uint32_t>(a.channel);
    if (reply) {
        const std::uint16_t asked = j.request.code;
        if (asked == code::start_online) {
            if (reply->quit == quit::no_external_stop) {
                (void)ended_by_quit(a, *reply, t, "the external-stop input must be defined and carry power before ONLINE starts");
                return;
            }
            // Somebody may have changed the mode in the same moment: then it is decided anew.
            if (reply->quit != 0 && !(is_online(mode_) && j.rounds++ < rounds_limit)) {
                (void)ended_by_quit(a, *reply, t);
                return;
            }
            if (reply->quit == 0) started_by_us_ = true;
        } else if (asked == code::abort_online) {
            if (reply->quit != 0) {
                (void)ended_by_quit(a, *reply, t);
                return;
            }
            j.step = 1;
        } else if (asked == code::stop_axis) {
            // Whatever was interrupted counts as finished now; a refusal means that there was nothing.
            if (mode_ == status::online && error_ == 0) return ask(a, code::axis_on, ch, t);
        } else if (asked == code::axis_on) {
            // 15h: this axis has no switch; it is on with ONLINE.
            if (reply->quit != 0 && reply->quit != quit::not_executable) {
                (void)ended_by_quit(a, *reply, t);
                return;
            }
            if (options_.release && !a.fb.referenced) return ask(a, code::no_reference, ch, t);
            if (!is_online(mode_)) return refuse(a, Reason::wrong_state, why_not_online(), t);
        } else if (asked == code::no_reference) {
            if (ended_by_quit(a, *reply, t)) return;
            a.fb.referenced = a.referenced_own = true;
        }
        if (asked == code::axis_on || asked == code::no_reference) {
            a.on = true;
            a.off_ordered = false;
            if (j.rounds > 0) keep_off(t);  // by way of home position
            give_back_due_ = false;
            emit(a, t);
            return job_over(a, j.command.until_done ? Outcome::done : Outcome::accepted, Reason::none, "", t);
        }
    }
    if (j.rounds > rounds_limit) return refuse(a, Reason::wrong_state, why_not_online(), t);
    if (j.step == 1 && is_online(mode_)) return wait(a, j.limit == never ? t.now + change_limit : j.limit);
    j.step = 0;
    if (mode_ == status::online && error_ == 0) {
        if (a.status == 8) {
            return refuse(a, Reason::wrong_state, fmt::format("axis {} is in measuring mode: leave it with measure off", a.channel), t);
        }
        return ask(a, code::stop_axis, ch, t);
    }
    if (mode_ == status::home && error_ == 0) {
        if (!options_.online_auto && !started_by_us_) {
            return refuse(a, Reason::wrong_state,
                          "the control is in home position and the option online is manual: start ONLINE with the action online.start", t);
        }
        const bool asked = std::ranges::any_of(axes_, [&](const Axis& x) {
            return &x != &a && x.job.active() && x.job.request.code == code::start_online &&
                   (x.job.in_flight || x.job.want == Job::Want::send);
        });
        if (asked) return wait(a, std::min(j.limit, t.now + change_limit));  // another axis is doing it
        ++j.rounds;
        return ask(a, code::start_online, 0, t);
    }
    if (mode_ == status::online_started || mode_ == status::online_stop || mode_ < 0) {
        j.text = "enable";
        return wait(a, std::min(j.limit, t.now + change_limit));
    }
    if (mode_ == status::online_stopped && error_ == 0) {
        ++j.rounds;
        return ask(a, code::abort_online, 0, t);
    }
    refuse(a, Reason::wrong_state, why_not_online(), t);
}

/// Errors of class 3 (500..999) go on the way to home position, those of class 2 by 0909 there [L2770-L2780].
void Drive::run_reset(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    if (reply) {
        if (j.request.code == code::reset_error && reply->quit != 0) {
            if (reply->quit == quit::not_executable) {
                ++counters_.refused;
                return job_over(
                    a, Outcome::failed, Reason::drive_refused,
                    fmt::format("the PA-CONTROL error E{} cannot be reset ({}): remove its cause, then switch the control off and on",
                                reply->data, describe_quit(reply->quit)),
                    t, reply->quit);
            }
            if (!(reply->quit == quit::inadmissible && j.rounds < rounds_limit)) {
                (void)ended_by_quit(a, *reply, t);
                return;
            }
        } else if (reply->quit != 0 && j.rounds >= rounds_limit) {
            (void)ended_by_quit(a, *reply, t);
            return;
        } else if (reply->quit == 0 && (j.request.code == code::abort_online || j.request.code == code::abort_auto)) {
            j.step = 1;
        } else if (j.request.code == code::status_axis && reply->quit == 0) {
            learn_status(a, static_cast<int>(number_of(*reply).value_or(-1)), t);
        }
    }
    const bool axis_fault = a.status == 4;
    if (j.step == 1 && (is_online(mode_) || is_automatic(mode_))) return wait(a, j.limit == never ? t.now + change_limit : j.limit);
    j.step = 0;
    if (mode_ < 0) return wait(a, t.now + change_limit);
    if (error_ == 0 && !is_malfunction(mode_) && !axis_fault) {
        a.fb.homing_error = false;
        if (j.rounds > 0) keep_off(t);
        emit_all(t);
        return job_over(a, j.command.until_done ? Outcome::done : Outcome::accepted, Reason::none, "", t);
    }
    if (j.rounds++ > rounds_limit) {
        return job_over(a, Outcome::failed, Reason::drive_refused,
                        fmt::format("the fault is still there: operating status {}, PA-CONTROL error E{}, axis status {}",
                                    status_text(mode_), error_, a.status),
                        t, error_);
    }
    if (is_manual(mode_)) return refuse(a, Reason::wrong_state, why_not_online(), t);
    if (is_online(mode_)) {
        return ask(a, code::abort_online, 0, t);
    }
    if (is_automatic(mode_)) return ask(a, code::abort_auto, 0, t);
    // Home position. An axis that shows a malfunction without an error is looked at again.
    if (error_ == 0 && !is_malfunction(mode_)) return ask(a, code::status_axis, static_cast<std::uint32_t>(a.channel), t);
    ask(a, code::reset_error, 0, t);
}

/// The actions online.start, online.stop, online.give_back, automatic.start, automatic.stop, automatic.cancel.
void Drive::start_mode(Axis& a, std::uint16_t what, Turn& t) {
    a.job.kind = Job::Kind::mode;
    a.job.step = what;
    run_mode(a, nullptr, t);
}

void Drive::run_mode(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const auto what = static_cast<std::uint16_t>(j.step);
    const bool there = what == code::start_online   ? mode_ == status::online
                       : what == code::abort_online ? !is_online(mode_)
                       : what == code::abort_auto   ? !is_automatic(mode_)
                       : what == code::start_auto   ? mode_ == status::auto_run
                                                    : mode_ == status::auto_stopped || mode_ == status::online_stopped || is_home(mode_);
    if (!reply && !j.active()) return;
    if (!reply && j.rounds == 0) {
        if (there && what != code::stop) {
            return job_over(a, Outcome::done, Reason::none, fmt::format("operating status is {} already", status_text(mode_)), t);
        }
        ++j.rounds;
        return ask(a, what, 0, t);
    }
    if (reply && reply->quit != 0) {
        (void)ended_by_quit(
            a, *reply, t,
            reply->quit == quit::no_external_stop ? "the external-stop input must be defined and carry power" : std::string_view());
        return;
    }
    if (reply) {
        if (what == code::start_online) started_by_us_ = false;  // started by hand: given back by hand
        if (!j.command.until_done) {
            return job_over(a, Outcome::accepted, Reason::none, fmt::format("operating status {}", status_text(mode_)), t);
        }
    }
    if (there) return job_over(a, Outcome::done, Reason::none, fmt::format("operating status {}", status_text(mode_)), t);
    wait(a, j.limit == never ? t.now + change_limit : j.limit);
}

/// The last axis is off: a control that this gateway brought into ONLINE goes back to home position, where parameters can be read, unless
/// an axis would have power there.
void Drive::consider_give_back(Turn& t) {
    // A parameter that waits for home position is a reason to go there, not one to stay; what stands behind it in the queue waits with it.
    const auto waits_for_home = [](const Axis& a) {
        return (a.job.kind == Job::Kind::read || a.job.kind == Job::Kind::write) && a.job.want == Job::Want::wait;
    };
    if (!(give_back_due_ || std::ranges::any_of(axes_, waits_for_home)) || !started_by_us_ || !options_.give_back_auto || leaving_ ||
        exchange_.active())
        return;
    if (mode_ != status::online && mode_ != status::online_stopped) return;
    // Neither a disable nor a parameter that waits is an order to give power to an axis of enable mode 1.
    for (const Axis& a : axes_) {
        if (powered_at_home(a) || a.on || a.running || a.motion.active()) return;
        if (!waits_for_home(a) && (a.job.active() || !a.queue.empty())) return;
    }
    give_back_due_ = false;
    leaving_ = true;
    send(Purpose::give_back, {code::abort_online, 0, false, "0"}, 0, Priority::command, t);
}

}  // namespace axisgate::pacontrol
