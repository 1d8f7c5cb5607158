// Verbs, part motion: absolute, relative and velocity moves, setting a position, starting several axes.
// In: the verbs of CiA 402. Out: 0A9A, 0A8D, 0A8E, 0A94, 0A95, 0A96, 0A85, 0A86.
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
}

DriveVerb::DriveVerb(Drive& drive) noexcept : Part(drive), jobs_(drive.jobs), feedback_(drive.feedback) {}

std::string_view DriveVerb::advice_for(std::uint16_t q) {
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

void Moves::run(Axis& a, const Reply* reply, Turn& t) {
    if (a.job.kind == Job::Kind::move) return run_move(a, reply, t);
    a.job.kind == Job::Kind::origin ? run_origin(a, reply, t) : run_together(a, reply, t);
}

bool Moves::fits(Axis& a, const Move& m, Turn& t) {
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    const auto refused = [&](Reason reason, std::string text) {
        jobs_.refuse(a, reason, std::move(text), t);
        return false;
    };
    if (m.target > most || m.target < -most)
        return refused(Reason::out_of_range, fmt::format("target {} is outside {}..{} increments of 0.001 AE", m.target, -most, most));
    for (const auto& v : {m.velocity, m.acceleration, m.deceleration}) {
        if (v && (*v < 1 || *v > most))
            return refused(Reason::out_of_range, fmt::format("speeds and accelerations are 1..{} increments/s, not {}", most, *v));
    }
    if (m.acceleration && m.deceleration && *m.acceleration != *m.deceleration)
        return refused(Reason::not_supported,
                       "a PA-CONTROL has one acceleration for both ramps: give acceleration and deceleration the same value, or one alone");
    return true;
}

/// False: the job has ended, or asks on.
bool Moves::move_goes_on(Axis& a, const Move& m, const Reply& reply, Turn& t) {
    Job& j = a.job;
    if (j.request.code == code::stop_axis && reply.quit == quit::unknown_command) {
        drive_.stop_axis_missing = true;
        jobs_.ask(a, code::abort_move);
        return false;
    }
    if (jobs_.ended_by_quit(a, reply, t, advice_for(reply.quit))) return false;
    switch (j.request.code) {
        case code::stop_axis:
        case code::abort_move:
            a.stopping_until = t.now + stand_limit;
            if (a.motion.active()) feedback_.end_motion(a, false, Reason::interrupted, "ended by a new motion", t);
            a.running = true;  // until 1911 says that it stands
            j.text = "the running motion was stopped first: a PA-CONTROL takes no new target while the axis moves";
            j.step = 1;
            return true;
        case code::set_speed:
            j.step = 3;
            return true;
        case code::set_acceleration:
            j.step = 4;
            return true;
        case code::area_min:
        case code::area_max:
            jobs_.ask(a, code::move_absolute, axis_text(increments_of(number_of(reply).value_or(0))));
            return false;
        default:
            break;
    }
    feedback_.learn_position(a, reply, t);  // it has begun
    Motion motion;
    motion.kind = m.kind == Move::Kind::velocity ? Motion::Kind::velocity : Motion::Kind::position;
    motion.target = m.kind == Move::Kind::relative ? a.counter + m.target : m.target;
    motion.conditional = a.condition_set;
    feedback_.begin_motion(a, motion, t);
    jobs_.accepted(a, m.kind == Move::Kind::velocity ? Wait::For::speed : Wait::For::target, m.target, std::move(j.text), t);
    return false;
}

/// Steps: 0 stop a running motion, 1 wait for standstill, 2 speed, 3 acceleration, 4 end of the area (velocity), or start.
void Moves::run_move(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const Move m = std::get<Move>(j.command.body);
    const bool endless = m.kind == Move::Kind::velocity;
    std::optional<std::int64_t> speed = m.velocity;
    if (endless) speed = m.target == 0 ? std::nullopt : std::optional<std::int64_t>(std::llabs(m.target));
    const auto ramp = m.acceleration ? m.acceleration : m.deceleration;
    if (reply && !move_goes_on(a, m, *reply, t)) return;
    if (jobs_.ended_by_state(a, t)) return;  // the world may have changed between two steps
    if (j.step == 0) {
        if (!fits(a, m, t)) return;
        if (a.moves()) return jobs_.ask(a, drive_.stop_axis_missing ? code::abort_move : code::stop_axis);
        j.step = 2;
    }
    if (j.step == 1) {
        if (a.running) return jobs_.wait(a, j.limit == never ? t.now + stand_limit : j.limit);
        j.step = 2;
    }
    if (endless && m.target == 0) {
        a.reached = false;
        feedback_.publish(a, t);
        return jobs_.accepted(a, Wait::For::standstill, 0, "the axis stands", t);
    }
    if (j.step == 2) {
        if (speed && a.speed != speed) return jobs_.ask(a, code::set_speed, axis_text(*speed));
        j.step = 3;
    }
    if (j.step == 3) {
        if (ramp && a.acceleration != ramp) return jobs_.ask(a, code::set_acceleration, axis_text(*ramp));
        j.step = 4;
    }
    // A control positions only; a velocity is a move to the end of the traverse area at that speed.
    if (endless) return jobs_.ask(a, m.target < 0 ? code::area_min : code::area_max);
    const std::uint16_t start = m.kind == Move::Kind::relative ? code::move_relative : code::move_absolute;
    if (!m.prepare_only) return jobs_.ask(a, start, axis_text(m.target));
    a.prepared = true;
    a.prepared_request = request_for(start, a.number(), axis_text(m.target));
    a.prepared_motion = {Motion::Kind::position, m.target};
    jobs_.over(a, Outcome::accepted, Reason::none, "prepared: start_together starts it", t);
}

/// G29 shifts the software limits with the position, G26 leaves them where they are; option set_position chooses.
void Moves::run_origin(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const std::int64_t wanted = std::get<SetPosition>(j.command.body).position;
    if (!reply) {
        if (jobs_.ended_by_state(a, t)) return;
        j.step = 1;
        if (drive_.options.set_by_g26 && wanted == 0) return jobs_.ask(a, code::position_null);
        return jobs_.ask(a, drive_.options.set_by_g26 ? code::reference_here : code::set_position, axis_text(wanted));
    }
    if (jobs_.ended_by_quit(a, *reply, t, j.step == 1 ? advice_for(reply->quit) : std::string_view())) return;
    if (j.step == 1) {
        if (j.request.code != code::set_position) a.fb.referenced = true;
        j.step = 2;
        return jobs_.ask(a, code::position);
    }
    a.reached = false;
    feedback_.learn_position(a, *reply, t);
    jobs_.finished(a, t);
}

// --- several axes ----------------------------------------------------------------------------------------------------------------

bool Moves::gather(Axis& a, Turn& t) {
    const auto refused = [&](std::string text) {
        jobs_.refuse(a, Reason::wrong_state, std::move(text), t);
        return false;
    };
    std::vector<std::size_t>& places = a.job.places;
    for (const AxisId id : std::get<StartTogether>(a.job.command.body).axes) {
        const Axis* x = drive_.axis_of(id);
        if (!x) return refused("one of the axes is not an axis of this control");
        if (std::string why = drive_.why_not_movable(*x); !why.empty()) return refused(std::move(why));
        if (!x->prepared) return refused(fmt::format("axis {} has no prepared motion", x->channel));
        places.push_back(x->place());
    }
    return places.empty() ? refused("no axes are named") : true;
}

void Moves::run_together(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    if (!reply && !gather(a, t)) return;
    if (reply) {
        Axis& x = drive_.axes[j.places[j.at]];
        x.prepared = false;
        if (reply->quit != 0) {
            ++drive_.bus.counters.refused;
            std::string text = fmt::format("{}: {}", describe(j.request), describe_quit(reply->quit));
            for (std::size_t i = 0; i < j.at; ++i) {
                const Axis& started = drive_.axes[j.places[i]];
                text += fmt::format("{}{}", i == 0 ? "; stopped again: axis " : ", ", started.channel);
                drive_.stops.add(Stops::Kind::halt, started);
            }
            return jobs_.over(a, j.at == 0 ? Outcome::refused : Outcome::failed, Reason::drive_refused, std::move(text), t, reply->quit);
        }
        feedback_.learn_position(x, *reply, t);
        Motion m = x.prepared_motion;
        if (j.request.code == code::move_relative) m.target += x.counter;
        m.conditional = x.condition_set;
        feedback_.begin_motion(x, m, t);
        ++j.at;
    }
    if (j.at < j.places.size()) return jobs_.ask(a, drive_.axes[j.places[j.at]].prepared_request);
    jobs_.over(a, Outcome::accepted, Reason::none,
               fmt::format("{} axes were started one behind the other: the control has no common start", j.places.size()), t);
}

}  // namespace axisgate::pacontrol
