// The axis interfaces: control and status word of each axis in ONLINE. A level acts only once, because the master writes its image in
// cycles.
#include <bit>
#include <cmath>

#include "gateway/registers/profiles/pacontrol.hpp"

namespace axisgate::registers {
using namespace pacontrol_errors;
namespace {
constexpr std::uint32_t on = 1u << 0, start = 1u << 2, reference = 1u << 3, set_and_reference = 1u << 4, set = 1u << 5, absolute = 1u << 6,
                        relative = 1u << 7, while_one = 1u << 8, while_zero = 1u << 9, jog_plus = 1u << 10, jog_minus = 1u << 11,
                        delete_offset = 1u << 12, reset_displaced = 1u << 13, to_highest = 1u << 14, to_lowest = 1u << 15,
                        reset_error = 1u << 16;
constexpr std::uint32_t tasks = reference | set_and_reference | set | absolute | relative | jog_plus | jog_minus | delete_offset |
                                reset_displaced | to_highest | to_lowest;
constexpr std::uint32_t motions = reference | absolute | relative | jog_plus | jog_minus | to_highest | to_lowest;
}  // namespace

void PaControlMap::switch_power(std::size_t i, bool power, WritePlan& plan) {
    order(plan, i, power ? CommandBody(Enable{}) : CommandBody(Disable{}), note(Asked::power, i, 0), Answer::done);
}

void PaControlMap::take_axis(std::size_t i, std::uint32_t before, WritePlan& plan) {
    AxisState& a = axes_[i];
    const auto rose = [&](std::uint32_t bit) { return (before & bit) == 0 && (a.control & bit) != 0; };
    const auto fell = [&](std::uint32_t bit) { return (before & bit) != 0 && (a.control & bit) == 0; };
    if (rose(reset_error)) {
        a.axis_error = 0;
        if (flag(i, flag_fault)) order(plan, i, ResetFault{}, note(Asked::power, i, 0), Answer::done);
    }
    if (fell(on) && mode_ != Mode::silent) switch_power(i, false, plan);
    if (mode_ != Mode::online) return;
    if (rose(on)) switch_power(i, true, plan);
    if (a.active && fell(a.task_bit)) {
        a.active = false;
        ++a.sequence;
        order(plan, i, Halt{}, note(Asked::nothing, i, 0), Answer::acknowledged);
    }
    if (rose(start) && !a.active) start_task(i, plan);
}

void PaControlMap::start_task(std::size_t i, WritePlan& plan) {
    AxisState& a = axes_[i];
    const std::uint32_t what = a.control & tasks;
    const double target = position_of(values_[axis_rows_[i][3]]);
    a.cmd_error = 0;
    if (std::popcount(what) != 1) {
        a.cmd_error = what == 0 ? not_executable : inadmissible;
        if (what != 0) a.axis_error = inadmissible;
        return;
    }
    if ((a.control & (while_one | while_zero)) != 0) {  // inputs belong to the real drive here
        a.cmd_error = not_executable;
        return;
    }
    if (!std::isfinite(target)) {
        a.cmd_error = outside_range;
        return;
    }
    // E-67: 1 to 1000 per mill, and an acceleration; a reference run has speeds of its own.
    const std::uint32_t speed_word = values_[axis_rows_[i][2]], acceleration_word = values_[axis_rows_[i][1]];
    if ((what & motions & ~reference) != 0 && (speed_word == 0 || speed_word > 1000 || acceleration_word == 0)) {
        a.cmd_error = outside_value;
        return;
    }
    if ((what & motions) != 0 && !enabled(i)) {
        a.cmd_error = switched_off;
        return;
    }
    if ((what & (absolute | relative | to_highest | to_lowest)) != 0 && !referenced(i)) {
        a.cmd_error = no_reference;
        return;
    }
    const auto& limit = what == to_highest ? axis(i).highest : axis(i).lowest;
    if ((what & (to_highest | to_lowest)) != 0 && !limit) {
        a.cmd_error = outside_range;
        return;
    }
    if (what == delete_offset || what == reset_displaced) return;
    const double speed = a.speed * speed_word / 1000, acceleration = a.acceleration * acceleration_word / 1000;
    const auto task = [&](CommandBody body) {
        a.active = true;
        a.task_bit = what;
        ++a.sequence;
        order(plan, i, std::move(body), note(Asked::axis, i, a.sequence), Answer::done);
    };
    const auto go = [&](Move::Kind kind, double to) {
        a.target = kind == Move::Kind::relative ? position(i) + to : to;
        task(move(i, kind, to, speed, acceleration));
    };
    switch (what) {
        case reference:
            return task(Home{});
        case set_and_reference:
            a.released = true;
            return task(SetPosition{increments(i, target)});
        case set:
            return task(SetPosition{increments(i, target)});
        case absolute:
            return go(Move::Kind::absolute, target);
        case relative:
            return go(Move::Kind::relative, target);
        case jog_plus:
            return go(Move::Kind::relative, std::fabs(target));
        case jog_minus:
            return go(Move::Kind::relative, -std::fabs(target));
        default:
            return go(Move::Kind::absolute, *limit);
    }
}

std::uint16_t PaControlMap::axis_number(std::size_t i) const {
    if (flag(i, flag_fault)) return 4;
    if (flag(i, flag_moving)) return 1;
    return flag(i, flag_target_reached) ? 0 : 2;
}

std::uint32_t PaControlMap::axis_status(std::size_t i) const {
    const AxisState& a = axes_[i];
    if (!a.configured) return 0;
    const bool powered = enabled(i), fault = flag(i, flag_fault);
    std::uint32_t s = (1u << 9) | (1u << 10);  // limit switches: 1 means not actuated
    if (powered) s |= 1u << 0;
    if (powered && mode_ == Mode::stopping && !flag(i, flag_moving)) s |= 1u << 1;
    if (!powered) s |= 1u << 2;
    if (!powered && (a.control & on) == 0) s |= 1u << 4;
    if (fault) s |= 1u << 6;
    if (a.active || (a.task_bit != 0 && (a.control & start) != 0 && (a.control & a.task_bit) != 0)) s |= 1u << 7;
    if (referenced(i)) s |= 1u << 8;
    if (a.cmd_error != 0) s |= 1u << 14;
    if (a.axis_error != 0 || fault) s |= 1u << 15;
    return s;
}

}  // namespace axisgate::registers
