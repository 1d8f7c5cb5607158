// Polls: the cycles.
// In: who runs, who stands, how long the last cycle took. Out: 1911 (who runs), positions, speeds or following errors of those that run,
// some of those that stand, and one slow thing per cycle.
#include "adapters/pacontrol/polls.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr Duration longest_cycle = std::chrono::seconds(10);
constexpr Duration standing_age = std::chrono::milliseconds(2400);  // below the 3 s from which a byte line's data count as stale
constexpr int standing_cycles = 4;                                  // in which each axis that stands is asked once while none moves
constexpr std::size_t axes_per_running = 16;                        // that move, for each 1911
constexpr std::size_t parameters_per_cycle = 4;
}  // namespace

void Polls::plan_cycle(Instant now) {
    const Duration period = pace_.period(drive_.bus.timing.poll_period);
    cycle_time_ = std::clamp<Duration>(now - cycle_began_, period, longest_cycle);
    cycle_began_ = now;
    cycle_at_ = now + period;
    std::size_t moving = 0;
    waiting_.push_back({code::running_axes});
    for (Axis& a : drive_.axes) {
        if (!a.here()) continue;
        const bool lag = a.demand.has_lag();
        if (first_cycle_) {
            add(code::position, a);
            if (!drive_.system_flags_missing) add(code::system_flag, a);
            add(a.status_code(), a);
        } else if (a.motion.final_due) {
            add(a.status_code(), a);
            if (lag) add(code::following_error, a);
            add(code::position, a);
        } else if (a.moves() || !a.position_known) {
            // Ends are seen soon, however many move.
            if (++moving % axes_per_running == 0) waiting_.push_back({code::running_axes});
            // Following error and speed share a place, so that the cycle takes no longer for it; the position it belongs to comes next.
            a.demand.lag_turn = lag && !a.demand.lag_turn;
            if (a.demand.lag_turn) add(code::following_error, a);
            add(code::position, a);
            if (!a.demand.lag_turn) add(code::speed, a);
        } else if (a.looked_at) {
            if (lag) add(code::following_error, a);
            add(code::position, a);
            add(a.status_code(), a);
        } else if (a.demand.lag_due && lag) {
            add(code::following_error, a);
        }
    }
    if (!first_cycle_) {
        plan_standing(moving > 0);
        plan_slow(now);
        plan_parameters(now);
    }
    first_cycle_ = false;
}

/// Axes that stand, in turn: they may be pushed, or their position be set at the control. So many of them that what is known of each is
/// never older than `standing_age` where the line allows it; where axes move, not one more.
void Polls::plan_standing(bool crowded) {
    const auto stands = [](const Axis& a) { return a.here() && !a.moves() && !a.looked_at && a.position_known; };
    const auto standing = static_cast<std::size_t>(std::ranges::count_if(drive_.axes, stands));
    const double wanted = crowded ? static_cast<double>(standing) * seconds(cycle_time_) / seconds(standing_age)
                                  : static_cast<double>(standing) / standing_cycles;
    auto left = std::min(standing, static_cast<std::size_t>(std::ceil(wanted)));
    for (std::size_t k = 0; k < drive_.axes.size() && left > 0; ++k) {
        idle_at_ = (idle_at_ + 1) % drive_.axes.size();
        const Axis& a = drive_.axes[idle_at_];
        if (!stands(a)) continue;
        --left;
        if (a.demand.has_lag()) add(code::following_error, a);  // held, it may be pushed without its counter moving
        add(code::position, a);
        add(a.status_code(), a);
    }
}

/// One thing per cycle of what seldom changes: the switches of an axis that moves, references, and in home position parameters.
void Polls::plan_slow(Instant now) {
    const std::size_t all = 3 * drive_.axes.size();
    for (std::size_t k = 0; k < all; ++k) {
        slow_at_ = (slow_at_ + 1) % all;
        Axis& a = drive_.axes[slow_at_ / 3];
        const std::size_t what = slow_at_ % 3;
        if (!a.here()) continue;
        if (what == 0 && a.running) return add(a.status_code(), a);
        if (what == 1 && !drive_.system_flags_missing) return add(code::system_flag, a);
        if (what == 2 && drive_.parameters_readable(now)) {
            std::uint8_t& next = a.demand.next_parameter;
            add(code::axis_parameter, a, next);
            next = static_cast<std::uint8_t>((next + 1u) % AxisDemand::numbers.size());
            return;
        }
    }
}

/// A few at a time, in home position, where nothing moves and nothing else is urgent. Those that are known are looked at again in the
/// slow round: they can be changed at the control.
void Polls::plan_parameters(Instant now) {
    if (!drive_.parameters_readable(now)) return;
    std::size_t planned = 0;
    for (const Axis& a : drive_.axes) {
        if (!a.here()) continue;
        for (std::uint8_t k = 0; k < AxisDemand::numbers.size(); ++k) {
            if (a.demand.parameters[k].read) continue;
            add(code::axis_parameter, a, k);
            if (++planned == parameters_per_cycle) return;
        }
    }
}

void Polls::drop(std::uint16_t code, const Axis* a) {
    std::erase_if(waiting_, [&](const Poll& p) { return p.code == code && (!a || p.axis == a->place()); });
}

void Polls::soon(std::uint16_t code, const Axis& a) {
    drop(code, &a);
    waiting_.push_front({code, a.place()});
}

void Polls::soon_standing(const Axis& a) {
    soon(a.status_code(), a);
    soon(code::position, a);
    if (a.demand.has_lag()) soon(code::following_error, a);
}

Sent Polls::next(Instant now) {
    if (waiting_.empty()) plan_cycle(now);
    const Poll p = waiting_.front();
    waiting_.pop_front();
    const auto axis = static_cast<std::uint32_t>(p.axis) + 1;
    const std::uint32_t parameter = p.code == code::running_axes     ? 0
                                    : p.code == code::system_flag    ? referenced_flag + axis
                                    : p.code == code::axis_parameter ? axis << 8 | AxisDemand::numbers[p.parameter]
                                                                     : axis;
    return {Purpose::poll, p.axis, request_for(p.code, parameter), false, p};
}

}  // namespace axisgate::pacontrol
