// Drive, part polls: what is asked again and again, in which order, and what the answers say.
// In: turns on the line. Out: 1911 (who runs), positions, speeds or following errors of those that run, and one slow thing per cycle.
// Never asks for what the control has said it does not have.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr Duration longest_cycle = std::chrono::seconds(10);
constexpr Duration standing_age = std::chrono::milliseconds(2400);  // below the 3 s from which a byte line's data count as stale
constexpr int standing_cycles = 4;                                  // in which each axis that stands is asked once while none moves
constexpr std::size_t axes_per_running = 16;                        // that move, for each 1911
}  // namespace

bool Drive::poll_wanted(Instant now) const noexcept { return !polls_.empty() || cycle_at_ <= now; }

void Drive::plan_cycle(Turn& t) {
    cycle_time_ = std::clamp<Duration>(t.now - cycle_began_, line_.timing.poll_period, longest_cycle);
    cycle_began_ = t.now;
    cycle_at_ = t.now + line_.timing.poll_period;
    std::size_t moving = 0;
    polls_.push_back({PollKind::running, 0});
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        Axis& a = axes_[i];
        if (a.id == no_axis || a.missing) continue;
        if (first_cycle_) {
            polls_.push_back({PollKind::position, i});
            if (!system_flags_missing_) polls_.push_back({PollKind::referenced, i});
            polls_.push_back({status_poll(a), i});
        } else if (a.motion.final_due) {
            polls_.push_back({status_poll(a), i});
            if (tells_following_error(a)) polls_.push_back({PollKind::following, i});
            polls_.push_back({PollKind::position, i});
        } else if (a.running || a.motion.active() || !a.position_known) {
            // Ends are heard soon, however many move.
            if (++moving % axes_per_running == 0) polls_.push_back({PollKind::running, 0});
            // Following error and speed share a place, so that the cycle takes no longer for it; the position it belongs to comes next.
            a.aim.lag_turn = tells_following_error(a) && !a.aim.lag_turn;
            if (a.aim.lag_turn) polls_.push_back({PollKind::following, i});
            polls_.push_back({PollKind::position, i});
            if (!a.aim.lag_turn) polls_.push_back({PollKind::speed, i});
        } else if (a.aim.lag_due && tells_following_error(a)) {
            polls_.push_back({PollKind::following, i});
        }
    }
    if (!first_cycle_) {
        plan_standing(moving > 0);
        plan_slow(t);
        plan_parameters(t);
    }
    first_cycle_ = false;
}

/// Axes that stand, in turn: they may be pushed, or their position be set at the control. So many of them that what is told of each is
/// never older than `standing_age` where the line allows it; where axes move, not one more.
void Drive::plan_standing(bool crowded) {
    const std::size_t n = axes_.size();
    const auto stands = [&](const Axis& a) {
        return a.id != no_axis && !a.missing && !a.running && !a.motion.active() && a.position_known;
    };
    const auto standing = static_cast<std::size_t>(std::ranges::count_if(axes_, stands));
    const double wanted = crowded ? static_cast<double>(standing) * seconds(cycle_time_) / seconds(standing_age)
                                  : static_cast<double>(standing) / standing_cycles;
    auto left = std::min(standing, static_cast<std::size_t>(std::ceil(wanted)));
    for (std::size_t k = 0; k < n && left > 0; ++k) {
        idle_at_ = (idle_at_ + 1) % n;
        const Axis& a = axes_[idle_at_];
        if (!stands(a)) continue;
        --left;
        if (tells_following_error(a))
            polls_.push_back({PollKind::following, idle_at_});  // held, it may be pushed without its counter moving
        polls_.push_back({PollKind::position, idle_at_});
        polls_.push_back({status_poll(a), idle_at_});
    }
}

/// One thing per cycle of what seldom changes: the switches of an axis that moves, references, and in home position parameters.
void Drive::plan_slow(Turn& t) {
    const std::size_t n = axes_.size();
    for (std::size_t k = 0; k < 3 * n; ++k) {
        slow_at_ = (slow_at_ + 1) % (3 * n);
        const std::size_t i = slow_at_ / 3, what = slow_at_ % 3;
        Axis& a = axes_[i];
        if (a.id == no_axis || a.missing) continue;
        if ((what == 0 && !a.running) || (what == 1 && system_flags_missing_) || (what == 2 && !parameters_readable(t.now))) continue;
        if (what == 2) {
            std::uint8_t& next = a.aim.next_parameter;
            polls_.push_back({PollKind::parameter, i, next});
            next = static_cast<std::uint8_t>((next + 1u) % Aim::numbers.size());
        } else {
            polls_.push_back({what == 1 ? PollKind::referenced : status_poll(a), i});
        }
        return;
    }
}

void Drive::poll_soon(PollKind kind, const Axis& a) {
    std::erase_if(polls_, [&](const Poll& p) { return p.kind == kind && p.axis == place(a); });
    polls_.push_front({kind, place(a)});
}

/// Of an axis that has come to rest: what it is behind, where it is, and how.
void Drive::poll_standing(Axis& a) {
    poll_soon(status_poll(a), a);
    poll_soon(PollKind::position, a);
    if (tells_following_error(a)) poll_soon(PollKind::following, a);
}

void Drive::send_next_poll(Turn& t) {
    if (polls_.empty()) plan_cycle(t);
    const Poll p = polls_.front();
    polls_.pop_front();
    const auto axis = static_cast<std::uint32_t>(p.axis) + 1;
    Request r;
    switch (p.kind) {
        case PollKind::running:
            r = {code::running_axes, 0, false, "0"};
            break;
        case PollKind::position:
            r = {code::position, axis, true, "0"};
            break;
        case PollKind::speed:
            r = {code::speed, axis, true, "0"};
            break;
        case PollKind::status:
            r = {code::status_axis, axis, false, "0"};
            break;
        case PollKind::extended:
            r = {code::extended_status, axis, false, "0"};
            break;
        case PollKind::referenced:
            r = {code::system_flag, referenced_flag + axis, false, "0"};
            break;
        case PollKind::following:
            r = {code::following_error, axis, true, "0"};
            break;
        case PollKind::parameter:
            r = {code::axis_parameter, axis << 8 | Aim::numbers[p.parameter], true, "0"};
            break;
    }
    send(Purpose::poll, r, p.axis, Priority::poll, t);
    exchange_.poll = p;
}

void Drive::poll_answered(const Poll& p, const Reply& reply, Turn& t) {
    Axis& a = axes_[p.axis];
    if (p.kind == PollKind::parameter) parameter_answered(a, p.parameter, reply, t);
    if (reply.quit != 0) {
        if (p.kind == PollKind::following) following_refused(a, reply);
        ++counters_.refused;
        if (reply.quit == quit::axis_unknown && !a.missing) {
            a.missing = true;
            notice(Severity::alarm, "setup", reply.quit,
                   fmt::format("the control has no axis {} ({}): take it out of the site, or raise system parameter 2 (number of axes)",
                               a.channel, describe_quit(reply.quit)),
                   t, a.id);
        } else if (reply.quit != quit::inadmissible) {
            if (p.kind == PollKind::extended) a.extended_missing = true;
            if (p.kind == PollKind::status) a.status_at = t.now;  // asked, and it does not say
            if (p.kind == PollKind::referenced) system_flags_missing_ = true;
        }
        return;
    }
    const double v = number_of(reply).value_or(0);
    const auto n = std::fabs(v) < 4e9 ? static_cast<std::uint32_t>(std::llround(std::fabs(v))) : 0u;
    switch (p.kind) {
        case PollKind::running:
            return learn_running(n, t);
        case PollKind::speed:
            a.fb.velocity = increments_of(v);
            a.velocity_at = t.now;
            if (a.motion.kind == Motion::Kind::velocity || a.motion.kind == Motion::Kind::position) {
                // Whether the control gives the speed a sign is not said [L2885]: the direction of a commanded motion is known.
                const bool down = a.motion.kind == Motion::Kind::velocity ? a.motion.target < 0 : a.motion.target < a.counter;
                a.fb.velocity = down ? -std::llabs(a.fb.velocity) : std::llabs(a.fb.velocity);
            }
            return emit(a, t);
        case PollKind::referenced:
            a.fb.referenced = n != 0;
            return;
        case PollKind::status:
            return learn_status(a, static_cast<int>(n), t);
        case PollKind::extended:
            // Byte 0, the highest: power pack ready; 1 positive and 2 negative limit switch (1: free); 3 axis status [L3164-L3194].
            a.limits = static_cast<int>((n >> 24 & 1u) | (n >> 16 & 1u) << 1 | (n >> 8 & 1u) << 2);
            learn_status(a, static_cast<int>(n & 0xFFu), t);
            return;
        case PollKind::following:
            following_answered(a, v, t);
            if (!a.running) emit(a, t);  // of one that runs the position is asked next: they are told together
            return;
        case PollKind::parameter:
            return;
        case PollKind::position:
            break;
    }
    const bool ends = a.motion.final_due && a.status >= 0 && a.status != 1;
    if (!ends) return learn_position(a, v, t);
    const std::int64_t position = increments_of(v);
    const Motion m = a.motion;
    std::string why;
    bool reached = m.kind == Motion::Kind::position || m.kind == Motion::Kind::manual;
    const std::string cause = what_ended(a);
    const std::int64_t slack = std::max<std::int64_t>(50, std::llabs(m.target) / 100'000);  // 7 digits, and the step of a gear
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
    a.aim.fresh = true;
    a.running = false;
    rest(a, reached && m.kind == Motion::Kind::position ? m.target : position);
    end_motion(a, reached, a.status == 4 && error_ != 0 ? Reason::drive_refused : Reason::interrupted,
               fmt::format("axis {} has stopped at {}, target {}: {}", a.channel, axis_text(position), axis_text(m.target), why), t);
    if (reached && stands_behind(a))
        notice(Severity::warning, "motion", a.status,
               fmt::format("axis {}: in position by its counter, but the shaft is {} behind: it is held or has lost steps", a.channel,
                           axis_text(following_error(a))),
               t, a.id);
    if (!reached)
        notice(Severity::info, "motion", a.status, fmt::format("axis {}: {}, at {}", a.channel, why, axis_text(position)), t, a.id);
}

}  // namespace axisgate::pacontrol
