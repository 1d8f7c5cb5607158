// The CMD interface: one command per change of its toggle, answered at once or when the axis has carried it out. Codes and errors are those
// of chapter 5 of the interface manual; E numbers are its errata.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "gateway/registers/profiles/pacontrol.hpp"

namespace axisgate::registers {
using namespace pacontrol_errors;

void PaControlMap::answer(std::uint32_t data) { reply_.data = data; }
void PaControlMap::answer(double value) { reply_.data = bits_of(MapType::f32, value); }
void PaControlMap::fail(std::uint16_t error) {
    reply_.failed = reply_.done = true;
    reply_.error = error;
}

void PaControlMap::wait_for(std::size_t i, CommandBody body, bool until_done, WritePlan& plan) {
    reply_.done = false;
    ++reply_.waits;
    order(plan, i, std::move(body), note(Asked::cmd, i, reply_.sequence), until_done ? Answer::done : Answer::acknowledged);
}

void PaControlMap::execute(std::uint16_t code, std::uint16_t parameter, std::uint32_t data, WritePlan& plan) {
    reply_ = Reply{.sequence = reply_.sequence + 1};
    if (!execute_mode(code, plan) && !execute_element(code, parameter, data) && !execute_parameter(code, parameter, data) &&
        !execute_read(code, parameter) && !execute_axis(code, parameter, data, plan))
        fail(unknown_command);
}

bool PaControlMap::execute_mode(std::uint16_t code, WritePlan& plan) {
    switch (code) {
        case 0x0600:
            if (mode_ != Mode::online) return fail(inadmissible), true;
            return stop_all(plan), true;
        case 0x0602:  // there are no programs here
            return fail(mode_ == Mode::home ? not_executable : inadmissible), true;
        case 0x0603:
            if (mode_ != Mode::home && (mode_ != Mode::stopping || any_moving())) return fail(inadmissible), true;
            return start_online(plan), true;
        case 0x0A41:
            return fail(inadmissible), true;
        case 0x0A81:
            if (mode_ != Mode::online && mode_ != Mode::stopping) return fail(inadmissible), true;
            return leave_online(plan), true;
        case 0x0909:
            if (mode_ != Mode::home) return fail(inadmissible), true;
            reset_faults(plan, Asked::cmd);
            reply_.done = reply_.waits == 0;
            return true;
        default:
            return false;
    }
}

bool PaControlMap::execute_element(std::uint16_t code, std::uint16_t n, std::uint32_t data) {
    const bool there = n >= 1 && n <= elements;
    const std::size_t word = there ? 16 * ((n - 1u) / 16) : 0;  // flags of a word are word + 1 .. word + 16
    switch (code) {
        case 0x0904:
            if (!there) return fail(no_flag), true;
            if (data > 1) return fail(outside_value), true;
            flags_[n] = data != 0;
            return answer(data), true;
        case 0x1904:
            return there ? answer(std::uint32_t{flags_[n]}) : fail(no_flag), true;
        case 0x0905:
            if (!there) return fail(no_flag), true;
            for (std::size_t b = 0; b < 16; ++b)
                flags_[word + 1 + b] = (data >> b & 1u) != 0;
            return answer(data & 0xFFFFu), true;
        case 0x1905: {
            if (!there) return fail(no_flag), true;
            std::uint32_t bits = 0;
            for (std::size_t b = 0; b < 16; ++b)
                bits |= std::uint32_t{flags_[word + 1 + b]} << b;
            return answer(bits), true;
        }
        case 0x0906:
            if (!there) return fail(no_integer), true;
            return answer(integers_n_[n] = data), true;
        case 0x1906:
            return there ? answer(integers_n_[n]) : fail(no_integer), true;
        case 0x0907:
            if (!there) return fail(no_real), true;
            return answer(reals_[n] = data), true;
        case 0x1907:
            return there ? answer(reals_[n]) : fail(no_real), true;
        case 0x1900:
        case 0x1901:
            return fail(no_input), true;
        case 0x0902:
        case 0x1902:
        case 0x0903:
        case 0x1903:
            return fail(no_output), true;
        default:
            return false;
    }
}

double* PaControlMap::axis_parameter(std::size_t i, std::uint8_t number) {
    AxisState& a = axes_[i];
    switch (number) {
        case 0x01:
            return &a.speed;
        case 0x02:
            return &a.reference_speed;
        case 0x03:
            return &a.manual_speed;
        case 0x06:
            return &a.acceleration;
        case 0x32:
            return &a.enable_mode;
        default:
            return nullptr;
    }
}

bool PaControlMap::execute_parameter(std::uint16_t code, std::uint16_t parameter, std::uint32_t data) {
    if (code == 0x0700 || (code >= 0x1700 && code <= 0x1702)) {
        if (mode_ != Mode::home) return fail(inadmissible), true;
        if (parameter != 0x02)
            return fail(no_system_parameter), true;  // the number of axes; the others are settings of a controller that does not exist here
        return code == 0x0700 ? fail(not_executable) : answer(static_cast<std::uint32_t>(axes())), true;
    }
    if (code != 0x0800 && (code < 0x1800 || code > 0x1802)) return false;
    const std::size_t i = (parameter >> 8) - std::size_t{1};
    const auto number = static_cast<std::uint8_t>(parameter & 0xFF);
    if (mode_ != Mode::home) return fail(inadmissible), true;
    if (i >= axes()) return fail(no_axis_of_number), true;
    if (number == 0x08 || number == 0x09) {
        const auto& limit = number == 0x08 ? axis(i).lowest : axis(i).highest;
        if (!limit) return fail(no_axis_parameter), true;
        return code == 0x0800 ? fail(inadmissible) : answer(*limit), true;
    }
    double* const value = axis_parameter(i, number);
    if (!value) return fail(no_axis_parameter), true;
    if (code == 0x1802) return answer(0.0), true;
    if (code == 0x1801) return answer(number == 0x32 ? 1.0 : static_cast<double>(std::numeric_limits<float>::max())), true;
    if (code == 0x0800) {
        const double v = number_of(MapType::f32, data);
        if (!(v >= 0) || !std::isfinite(v) || (number == 0x32 && v != 0 && v != 1)) return fail(outside_value), true;
        *value = v;
    }
    return answer(*value), true;
}

bool PaControlMap::execute_read(std::uint16_t code, std::uint16_t n) {
    switch (code) {
        case 0x1909:
            return answer(std::uint32_t{system_error()}), true;
        case 0x190B:
            return answer(std::uint32_t{operating_status()}), true;
        case 0x1911: {
            std::uint32_t bits = 0;
            for (std::size_t i = 0; i < axes(); ++i)
                bits |= flag(i, flag_moving) ? 1u << i : 0u;
            return answer(bits), true;
        }
        case 0x1934:
            if (n >= 51 && n < 51 + axes()) return answer(std::uint32_t{referenced(n - 51u)}), true;
            if (n >= 91 && n < 91 + axes()) return answer(std::uint32_t{flag(n - 91u, flag_moving)}), true;
            if (n >= 231 && n < 231 + axes()) return answer(std::uint32_t{flag(n - 231u, flag_fault)}), true;
            return fail(no_flag), true;
        case 0x1935:
            if (n == 10) return answer(std::uint32_t{system_error()}), true;
            if (n >= 71 && n < 71 + axes()) return answer(std::uint32_t{axis_number(n - 71u)}), true;
            return fail(no_integer), true;
        case 0x1937:
            if (n >= 71 && n < 71 + axes()) return answer(axes_[n - 71u].target), true;
            return fail(no_real), true;
        default:
            break;
    }
    if (code != 0x190C && code != 0x190D && code != 0x190E && code != 0x190F && code != 0x1910 && code != 0x1913 && code != 0x1914 &&
        code != 0x1915 && code != 0x1920 && code != 0x1921)
        return false;
    const std::size_t i = n - std::size_t{1};
    if (i >= axes()) return fail(no_axis_of_number), true;
    switch (code) {
        case 0x190C:
            return answer(position(i)), true;
        case 0x190D:
            return answer(std::fabs(velocity(i))), true;
        case 0x1910:
            return answer(std::uint32_t{axis_number(i)}), true;
        case 0x1913:
            return axis(i).lowest ? answer(*axis(i).lowest) : fail(no_axis_parameter), true;
        case 0x1914:
            return axis(i).highest ? answer(*axis(i).highest) : fail(no_axis_parameter), true;
        case 0x1921:  // limit switches belong to the real drive: not activated
            return answer((flag(i, flag_online) ? 0x0100'0000u : 0u) | 0x0001'0100u | axis_number(i)), true;
        default:  // values of the controller's own power packs
            return fail(not_executable), true;
    }
}

void PaControlMap::move_axis(std::size_t i, Move::Kind kind, double target, bool until_there, WritePlan& plan) {
    AxisState& a = axes_[i];
    if (!std::isfinite(target)) return fail(outside_value);
    if (!enabled(i)) return fail(switched_off);
    if (flag(i, flag_moving)) return fail(still_moves);
    if (!referenced(i)) return fail(no_reference);
    a.target = kind == Move::Kind::relative ? position(i) + target : target;
    reply_.axis = i;
    reply_.live = until_there;
    answer(position(i));
    wait_for(i,
             move(i, kind, target, a.online_speed > 0 ? a.online_speed : a.speed,
                  a.online_acceleration > 0 ? a.online_acceleration : a.acceleration),
             until_there, plan);
}

bool PaControlMap::execute_axis(std::uint16_t code, std::uint16_t parameter, std::uint32_t data, WritePlan& plan) {
    if (code < 0x0A83 || code > 0x0AA3 || code == 0x0A88 || (code >= 0x0A8A && code <= 0x0A8C) || code == 0x0A8F || code == 0x0A99 ||
        (code >= 0x0A9B && code <= 0x0A9F))
        return false;
    const std::size_t i = parameter - std::size_t{1};
    const double value = number_of(MapType::f32, data);
    if (mode_ != Mode::online || interfaces_) return fail(inadmissible), true;
    if (code != 0x0AA2 && code != 0x0AA3 && i >= axes()) return fail(no_axis_of_number), true;
    switch (code) {
        case 0x0A83:
            return void(axes_[i].released = true), true;
        case 0x0A84:
            return enabled(i) ? wait_for(i, Home{}, true, plan) : fail(switched_off), true;
        case 0x0A85:
            return wait_for(i, SetPosition{0}, false, plan), true;
        case 0x0A86:
        case 0x0A96:
            if (!std::isfinite(value)) return fail(outside_value), true;
            if (code == 0x0A96) axes_[i].released = true;
            answer(data);
            return wait_for(i, SetPosition{increments(i, value)}, false, plan), true;
        case 0x0A87:
        case 0x0A94:
            return move_axis(i, Move::Kind::absolute, value, code == 0x0A87, plan), true;
        case 0x0A89:
        case 0x0A95:
            return move_axis(i, Move::Kind::relative, value, code == 0x0A89, plan), true;
        case 0x0A8D:
        case 0x0A8E:
            if (!(value > 0) || !std::isfinite(value)) return fail(outside_value), true;
            (code == 0x0A8D ? axes_[i].online_speed : axes_[i].online_acceleration) = value;
            return answer(data), true;
        case 0x0A93:
        case 0x0A9A:
            reply_.axis = i;
            reply_.live = true;
            return wait_for(i, Halt{}, code == 0x0A93, plan), true;
        case 0x0A97:
            return wait_for(i, Enable{}, true, plan), true;
        case 0x0A98:
            return wait_for(i, Disable{}, true, plan), true;
        case 0x0AA0:
            return fail(no_measuring_mode), true;
        case 0x0AA1:
            return true;
        case 0x0AA2:
            return data == 1 ? answer(data) : fail(not_executable), true;
        default:  // 0A90..0A92 need a time-out of one second, 0AA3 needs inputs: neither exists here
            return fail(not_executable), true;
    }
}

}  // namespace axisgate::registers
