// Drive, part motion: absolute, relative and velocity moves, reference runs, setting a position, starting several axes.
// In: the verbs of CiA 402. Out: 0A9A, 0A8D, 0A8E, 0A94, 0A95, 0A84, 0A96, 0A85, 0A86.
// Never uses 0A87 or 0A89 by itself: they bar the line until their end, and only one axis would move.
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr Duration stand_limit = std::chrono::seconds(10);  // a motion that was stopped for the next one has to stand within

std::string_view advice_for(std::uint16_t q) {
    switch (q) {
        case quit::no_reference:
            return "reference the axis first (home), or release it without a run (cmd_put_no_reference)";
        case quit::axis_moves:
            return "stop it first";
        case 0x29:
        case 0x41:
            return "the control's own limits are in the axis' parameters 1 to 9";
        case 0x37:
        case 0x2E:
            return "enable the axis again";
        case 0x38:
            return "it was displaced while it was off: reference it again";
        default:
            return {};
    }
}
}  // namespace

std::string Drive::why_not_movable(const Axis& a) const {
    if (mode_ == status::online_stopped || mode_ == status::online_stop) {
        return fmt::format("operating status {}: enable the axis again, or let interrupted motions go on with online.start",
                           status_text(mode_));
    }
    if (mode_ != status::online) return fmt::format("axes move in ONLINE alone; {}", why_not_online());
    if (a.status == 8) return fmt::format("axis {} is in measuring mode", a.channel);
    if (!a.on) return fmt::format("axis {} is not switched on: enable it first", a.channel);
    return {};
}

void Drive::start_move(Axis& a, const Move& m, Turn& t) {
    if (std::string why = why_not_movable(a); !why.empty()) return refuse(a, Reason::wrong_state, std::move(why), t);
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    if (m.target > most || m.target < -most) {
        return refuse(a, Reason::out_of_range, fmt::format("target {} is outside {}..{} increments of 0.001 AE", m.target, -most, most), t);
    }
    for (const auto& v : {m.velocity, m.acceleration, m.deceleration}) {
        if (v && (*v < 1 || *v > most)) {
            return refuse(a, Reason::out_of_range, fmt::format("speeds and accelerations are 1..{} increments/s, not {}", most, *v), t);
        }
    }
    if (m.acceleration && m.deceleration && *m.acceleration != *m.deceleration) {
        return refuse(a, Reason::not_supported,
                      fmt::format("a PA-CONTROL has one acceleration for both ramps: give {} and {} the same value, or one alone",
                                  "acceleration", "deceleration"),
                      t);
    }
    run(a, nullptr, t);
}

/// Steps: 0 stop a running motion, 1 wait for standstill, 2 speed, 3 acceleration, 4 end of the area (velocity), 5 condition or start.
void Drive::run_move(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const Move m = std::get<Move>(j.command.body);
    const auto ch = static_cast<std::uint32_t>(a.channel);
    std::optional<std::int64_t> speed = m.velocity;
    if (m.kind == Move::Kind::velocity) speed = m.target == 0 ? std::nullopt : std::optional<std::int64_t>(std::llabs(m.target));
    const auto ramp = m.acceleration ? m.acceleration : m.deceleration;
    if (reply) {
        if (ended_by_quit(a, *reply, t, advice_for(reply->quit))) return;
        switch (j.request.code) {
            case code::stop_axis:
                if (a.motion.active()) end_motion(a, false, Reason::interrupted, "ended by a new motion", t);
                a.running = true;  // until 1911 says that it stands
                j.text = "the running motion was stopped first: a PA-CONTROL takes no new target while the axis moves";
                j.step = 1;
                break;
            case code::set_speed:
                j.step = 3;
                break;
            case code::set_acceleration:
                j.step = 4;
                break;
            case code::area_min:
            case code::area_max:
                j.at = 1;
                ask_real(a, code::move_absolute, ch, axis_text(increments_of(number_of(*reply).value_or(0))), t);
                j.step = 5;
                return;
            default: {  // started
                learn_position(a, number_of(*reply).value_or(0), t);
                Motion motion;
                motion.kind = m.kind == Move::Kind::velocity ? Motion::Kind::velocity : Motion::Kind::position;
                motion.target = m.kind == Move::Kind::relative ? a.counter + m.target : m.target;
                motion.conditional = a.condition_set;
                begin_motion(a, motion, t);
                const Command c = j.command;
                std::string text = std::move(j.text);
                a.job = Job{};
                return accepted(a, c, m.kind == Move::Kind::velocity ? Wait::For::speed : Wait::For::target, m.target, std::move(text), t);
            }
        }
    }
    // The world may have changed between two steps.
    if (std::string why = why_not_movable(a); !why.empty()) return refuse(a, Reason::wrong_state, std::move(why), t);
    if (j.step == 0) {
        if (a.running || a.motion.active()) return ask(a, code::stop_axis, ch, t);
        j.step = 2;
    }
    if (j.step == 1) {
        if (a.running) return wait(a, j.limit == never ? t.now + stand_limit : j.limit);
        j.step = 2;
    }
    if (m.kind == Move::Kind::velocity && m.target == 0) {
        const Command c = j.command;
        a.reached = false;
        emit(a, t);
        a.job = Job{};
        return accepted(a, c, Wait::For::standstill, 0, "the axis stands", t);
    }
    if (j.step == 2) {
        if (speed && a.speed != speed) return ask_real(a, code::set_speed, ch, axis_text(*speed), t);
        j.step = 3;
    }
    if (j.step == 3) {
        if (ramp && a.acceleration != ramp) return ask_real(a, code::set_acceleration, ch, axis_text(*ramp), t);
        j.step = 4;
    }
    // A control positions only; a velocity is a move to the end of the traverse area at that speed.
    if (m.kind == Move::Kind::velocity) return ask(a, m.target < 0 ? code::area_min : code::area_max, ch, t);
    Request start{m.kind == Move::Kind::relative ? code::move_relative : code::move_absolute, ch, true, axis_text(m.target)};
    if (m.prepare_only) {
        a.prepared = true;
        a.prepared_request = start;
        a.prepared_motion = {};
        a.prepared_motion.kind = Motion::Kind::position;
        a.prepared_motion.target = m.target;
        return job_over(a, Outcome::accepted, Reason::none, "prepared: start_together starts it", t);
    }
    j.step = 5;
    ask(a, std::move(start));
}

// --- references ------------------------------------------------------------------------------------------------------------------

/// A run that has begun and did not come to its end. What ended it is told to whoever asked, and as an event: it may have its answer long
/// since.
void Drive::home_aborted(Axis& a, std::string text, std::int32_t code, Turn& t) {
    const Reason reason = in_trouble() || what_ended(a).empty() ? Reason::drive_refused : Reason::interrupted;
    a.running = false;
    end_motion(a, false, reason, text, t);
    a.fb.homing_attained = false;
    a.fb.homing_error = reason != Reason::interrupted;
    emit(a, t);
    notice(Severity::warning, "homing", code, fmt::format("axis {}: the reference run has not come to its end: {}", a.channel, text), t,
           a.id);
    job_over(a, Outcome::failed, reason, std::move(text), t, code);
}

void Drive::run_home(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const auto ch = static_cast<std::uint32_t>(a.channel);
    if (!reply) {
        if (j.step != 0) return;
        if (std::string why = why_not_movable(a); !why.empty()) return refuse(a, Reason::wrong_state, std::move(why), t);
        const auto* home = std::get_if<Home>(&j.command.body);
        const int method = home ? home->method : 0;
        j.step = 1;
        if (method == 0) return ask(a, code::reference, ch, t);
        if (method == 35 || method == 37) return ask_real(a, code::reference_here, ch, "0.0", t);
        return refuse(
            a, Reason::not_supported,
            fmt::format("homing method {}: the control's own reference run (0) is set by its axis parameters; 35 and 37 reference "
                        "the axis where it stands",
                        method),
            t);
    }
    const std::string cause = what_ended(a);
    if (j.step == 1) {
        if (reply->quit != 0 && !j.begun) {
            (void)ended_by_quit(a, *reply, t, advice_for(reply->quit));
            return;
        }
        if (reply->quit != 0) {
            ++counters_.refused;
            const std::string said = fmt::format("{}: {}", describe(j.request), describe_quit(reply->quit));
            return home_aborted(a, cause.empty() ? said : cause + "; " + said, error_ != 0 ? error_ : reply->quit, t);
        }
        if (!cause.empty()) return home_aborted(a, cause, error_, t);
        if (a.motion.kind != Motion::Kind::reference) begin_motion(a, {Motion::Kind::reference, 0, false, false, exchanges_}, t);
        j.step = 2;
        return ask(a, code::position, ch, t);
    }
    if (!cause.empty()) return home_aborted(a, cause, error_, t);
    if (j.step == 2) {
        if (reply->quit == 0) {
            a.counter = increments_of(number_of(*reply).value_or(0));
            a.counter_at = t.now;
            a.aim.fresh = true;
        }
        j.step = 3;
        if (!system_flags_missing_) return ask(a, {code::system_flag, referenced_flag + ch, false, "0"});
    }
    // "Done" is believed when the flag says so where the control has it.
    const bool asked = j.step == 3 && j.request.code == code::system_flag;
    const bool flag = !asked || reply->quit != 0 || number_of(*reply).value_or(0) != 0;
    if (!flag) return home_aborted(a, "end of processing was reported, but the axis is not referenced (SM flag 0)", 0, t);
    const bool until_done = j.command.until_done;
    a.running = false;
    end_motion(a, true, Reason::none, {}, t);
    job_over(a, until_done ? Outcome::done : Outcome::accepted, Reason::none, "", t);
}

/// G29 shifts the software limits with the position, G26 leaves them where they are; option set_position chooses.
void Drive::run_origin(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const auto ch = static_cast<std::uint32_t>(a.channel);
    const std::int64_t wanted = std::get<SetPosition>(j.command.body).position;
    if (!reply) {
        if (j.step != 0) return;
        if (std::string why = why_not_movable(a); !why.empty()) return refuse(a, Reason::wrong_state, std::move(why), t);
        j.step = 1;
        if (!options_.set_by_g26) return ask_real(a, code::set_position, ch, axis_text(wanted), t);
        if (wanted == 0) return ask(a, code::position_null, ch, t);
        return ask_real(a, code::reference_here, ch, axis_text(wanted), t);
    }
    if (j.step == 1) {
        if (ended_by_quit(a, *reply, t, advice_for(reply->quit))) return;
        if (j.request.code != code::set_position) a.fb.referenced = a.referenced_own = true;
        j.step = 2;
        return ask(a, code::position, ch, t);
    }
    if (ended_by_quit(a, *reply, t)) return;
    a.reached = false;
    learn_position(a, number_of(*reply).value_or(0), t);
    job_over(a, j.command.until_done ? Outcome::done : Outcome::accepted, Reason::none, "", t);
}

// --- several axes ----------------------------------------------------------------------------------------------------------------

void Drive::start_together(Axis& a, const StartTogether& what, Turn& t) {
    for (const AxisId id : what.axes) {
        Axis* x = axis_of(id);
        if (!x) return refuse(a, Reason::wrong_state, "one of the axes is not an axis of this control", t);
        if (std::string why = why_not_movable(*x); !why.empty()) return refuse(a, Reason::wrong_state, std::move(why), t);
        if (!x->prepared) return refuse(a, Reason::wrong_state, fmt::format("axis {} has no prepared motion", x->channel), t);
        a.job.places.push_back(place(*x));
    }
    if (a.job.places.empty()) return refuse(a, Reason::wrong_state, "no axes are named", t);
    run(a, nullptr, t);
}

void Drive::run_together(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    if (reply) {
        Axis& x = axes_[j.places[j.at]];
        x.prepared = false;
        if (reply->quit != 0) {
            ++counters_.refused;
            const std::string text = fmt::format("{}: {}", describe(j.request), describe_quit(reply->quit));
            std::string started;
            for (std::size_t i = 0; i < j.at; ++i) {
                started += fmt::format("{}{}", started.empty() ? "; stopped again: axis " : ", ", axes_[j.places[i]].channel);
                if (stops_.size() < stop_limit) stops_.push_back({Stop::Kind::halt, j.places[i]});
            }
            return job_over(a, j.at == 0 ? Outcome::refused : Outcome::failed, Reason::drive_refused, text + started, t, reply->quit);
        }
        learn_position(x, number_of(*reply).value_or(0), t);
        Motion m = x.prepared_motion;
        if (j.request.code == code::move_relative) m.target += x.counter;
        m.conditional = x.condition_set;
        begin_motion(x, m, t);
        ++j.at;
    }
    if (j.at >= j.places.size()) {
        return job_over(a, Outcome::accepted, Reason::none,
                        fmt::format("{} axes were started one behind the other: the control has no common start", j.places.size()), t);
    }
    ask(a, axes_[j.places[j.at]].prepared_request);
}

}  // namespace axisgate::pacontrol
