// What each of the 66 commands does. Numbers of lines are the manual's.
// In: parameter, data. Out: acknowledgement. The gate (mode) is checked before, here follow parameter, value, state, in this order.
// Never formats or parses a transport's form.
#include "adapters/pacontrol/twin/commands.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace axisgate::pacontrol::twin {
namespace {

using Awaits = CommandInProgress::Awaits;

CommandReply refuse(std::uint16_t q) { return {q, true, {}, never}; }
CommandReply say(double v) { return {0, true, Datum::integer(v), never}; }
CommandReply say_real(double v) { return {0, true, Datum::number(v), never}; }

int axis_of(const Call& c) { return static_cast<int>(c.parameter); }

// --- operating mode [L1975-2060] ---

CommandReply mode_reply(Control& k, std::uint16_t q, Instant now) { return q != 0 ? refuse(q) : k.begin({Awaits::mode, 0}, now); }
CommandReply stop(Control& k, const Call& c) { return mode_reply(k, k.operation().stop(c.now), c.now); }
CommandReply start_auto(Control& k, const Call& c) { return mode_reply(k, k.operation().start_automatic(c.now), c.now); }
CommandReply start_online(Control& k, const Call& c) { return mode_reply(k, k.operation().start_online(c.now), c.now); }
CommandReply cancel(Control& k, const Call& c) { return mode_reply(k, k.operation().cancel(c.now), c.now); }

// --- parameters [L2061-2345] ---

CommandReply set_system(Control& k, const Call& c) {
    const std::uint16_t q = k.settings().set_system(c.parameter, c.data);
    return q != 0 ? refuse(q) : say(std::round(c.data.value));
}

CommandReply get_system(Control& k, const Call& c) {
    if (c.parameter < 1 || c.parameter > static_cast<std::int64_t>(system_parameters)) return refuse(quit::no_system_parameter);
    const auto i = static_cast<std::size_t>(c.parameter);
    const auto limits = k.settings().system_limits(i);
    return say(c.code == 0x1700 ? k.settings().system()[i] : c.code == 0x1701 ? limits.largest : limits.least);
}

CommandReply set_axis_parameter(Control& k, const Call& c) {
    const std::uint16_t q = k.settings().set_axis(c.parameter, c.data);
    return q != 0 ? refuse(q) : say_real(static_cast<double>(single(c.data).value_or(0)));  // the example echoes (E-22)
}

CommandReply get_axis_parameter(Control& k, const Call& c) {
    if (c.parameter < 0 || !k.settings().has_axis(c.parameter >> 8)) return refuse(quit::no_axis);
    const auto number = static_cast<std::size_t>(c.parameter & 0xFF);
    if (number < 1 || number > axis_parameters) return refuse(quit::no_axis_parameter);
    const auto& limits = k.settings().axis_limits(number);
    const float v = c.code == 0x1801   ? limits.largest
                    : c.code == 0x1802 ? limits.least
                                       : k.axis(static_cast<int>(c.parameter >> 8)).parameters()[number];
    return say_real(static_cast<double>(v));
}

// --- elements [L2346-2770] ---

CommandReply get_input(Control& k, const Call& c) {
    if (!k.signals().elements().inputs.has(c.parameter)) return refuse(quit::no_input);
    return say(k.signals().shown_input(c.parameter) ? 1 : 0);
}

CommandReply get_input_word(Control& k, const Call& c) {
    if (!k.signals().elements().inputs.has(c.parameter)) return refuse(quit::no_input);
    int w = 0;
    const std::int64_t first = (c.parameter - 1) / 16 * 16 + 1;  // any input inside the word names it [L2430]
    for (int b = 0; b < 16; ++b)
        w |= (k.signals().shown_input(first + b) ? 1 : 0) << b;
    return say(w);
}

bool is_bit(const Datum& d) { return d.value == 0 || d.value == 1; }
bool is_word(const Datum& d) { return d.value >= 0 && d.value <= 65535; }

CommandReply put_output(Control& k, const Call& c) {
    if (!k.signals().elements().outputs.has(c.parameter)) return refuse(quit::no_output);
    if (!is_bit(c.data)) return refuse(quit::value);
    k.set_output(c.parameter, c.data.value != 0, c.now);
    return say(c.data.value);
}

CommandReply get_output(Control& k, const Call& c) {
    if (!k.signals().elements().outputs.has(c.parameter)) return refuse(quit::no_output);
    return say(k.signals().shown_output(c.parameter) ? 1 : 0);
}

CommandReply put_output_word(Control& k, const Call& c) {
    if (!k.signals().elements().outputs.has(c.parameter)) return refuse(quit::no_output);
    if (!is_word(c.data)) return refuse(quit::value);
    k.set_output_word(c.parameter, static_cast<std::uint16_t>(whole(c.data)), c.now);
    return say(whole(c.data));
}

CommandReply get_output_word(Control& k, const Call& c) {
    if (!k.signals().elements().outputs.has(c.parameter)) return refuse(quit::no_output);
    int w = 0;
    const std::int64_t first = (c.parameter - 1) / 16 * 16 + 1;
    for (int b = 0; b < 16; ++b)
        w |= (k.signals().shown_output(first + b) ? 1 : 0) << b;
    return say(w);
}

CommandReply put_flag(Control& k, const Call& c) {
    if (!k.signals().elements().flags.has(c.parameter)) return refuse(quit::no_flag);
    if (!is_bit(c.data)) return refuse(quit::value);
    k.set_flag(c.parameter, c.data.value != 0, c.now);
    return say(c.data.value);
}

CommandReply get_flag(Control& k, const Call& c) {
    if (!k.signals().elements().flags.has(c.parameter)) return refuse(quit::no_flag);
    return say(k.signals().elements().flags.get(c.parameter) ? 1 : 0);
}

CommandReply put_flag_word(Control& k, const Call& c) {
    if (!k.signals().elements().flags.has(c.parameter)) return refuse(quit::no_flag);
    if (!is_word(c.data)) return refuse(quit::value);
    k.set_flag_word(c.parameter, static_cast<std::uint16_t>(whole(c.data)), c.now);
    return say(whole(c.data));
}

CommandReply get_flag_word(Control& k, const Call& c) {
    if (!k.signals().elements().flags.has(c.parameter)) return refuse(quit::no_flag);
    return say(k.signals().elements().flags.word_of(c.parameter));
}

CommandReply put_n(Control& k, const Call& c) {
    if (!k.signals().elements().n.has(c.parameter)) return refuse(quit::no_n);
    if (std::abs(std::round(c.data.value)) > integer_limit) return refuse(quit::value);
    k.set_n(c.parameter, whole(c.data));
    return say(whole(c.data));
}

CommandReply get_n(Control& k, const Call& c) {
    if (!k.signals().elements().n.has(c.parameter)) return refuse(quit::no_n);
    return say(k.signals().elements().n.get(c.parameter));
}

CommandReply put_r(Control& k, const Call& c) {
    if (!k.signals().elements().r.has(c.parameter)) return refuse(quit::no_r);
    const auto v = single(c.data);
    if (!v) return refuse(quit::value);
    k.set_r(c.parameter, *v);
    return say_real(static_cast<double>(*v));
}

CommandReply get_r(Control& k, const Call& c) {
    if (!k.signals().elements().r.has(c.parameter)) return refuse(quit::no_r);
    return say_real(static_cast<double>(k.signals().elements().r.get(c.parameter)));
}

CommandReply reset_error(Control& k, const Call& c) {
    const std::uint16_t q = k.operation().reset_error(c.now);
    CommandReply r = say(q == quit::not_executable ? k.error() : 0);  // what could not be reset is named [L2780]
    r.quit = q;
    return r;
}

CommandReply get_error(Control& k, const Call&) { return say(k.shown_error()); }
CommandReply get_state(Control& k, const Call&) { return say(k.status()); }

/// Reads something of one axis.
template <class F>
CommandReply of_axis(Control& k, const Call& c, F&& f) {
    return k.settings().has_axis(c.parameter) ? f(k.axis(axis_of(c))) : refuse(quit::no_axis);
}

CommandReply get_position(Control& k, const Call& c) {
    return of_axis(k, c, [&](const Axis& a) { return say_real(a.shown().position(c.now)); });
}

CommandReply get_speed(Control& k, const Call& c) {
    return of_axis(k, c, [&](const Axis& a) { return say_real(a.shaft().velocity(c.now)); });
}

CommandReply get_encoder(Control& k, const Call& c) {
    return of_axis(k, c, [&](const Axis& a) { return a.model().ep ? say_real(a.shaft().encoder(c.now)) : refuse(quit::not_executable); });
}

double microsteps(const Axis& a, double ae) { return ae / std::max(1e-9, static_cast<double>(a.parameters()[ap::gear])) * 3200; }

/// The largest that has occurred since power on, in the microsteps of 1915. Only the EP has it; others: 15h (E-26).
CommandReply get_greatest_lag(Control& k, const Call& c) {
    return of_axis(k, c, [&](const Axis& a) {
        return a.model().ep ? say_real(microsteps(a, a.shaft().greatest_lag(c.now))) : refuse(quit::not_executable);
    });
}

CommandReply get_axis_status(Control& k, const Call& c) {
    return of_axis(k, c, [&](const Axis& a) { return say(a.shown().status().number); });
}

CommandReply get_running(Control& k, const Call&) {
    int mask = 0;
    for (int n = 1; k.settings().has_axis(n); ++n)
        mask |= (k.axis(n).shown().status().running ? 1 : 0) << (n - 1);
    return say(mask);
}

/// The stored parameter, without the shift of G29 (E-68).
CommandReply get_area_min(Control& k, const Call& c) {
    return of_axis(k, c, [&](const Axis& a) { return say_real(static_cast<double>(a.parameters()[ap::area_min])); });
}

CommandReply get_area_max(Control& k, const Call& c) {
    return of_axis(k, c, [&](const Axis& a) { return say_real(static_cast<double>(a.parameters()[ap::area_max])); });
}

/// Microsteps, 3200 per rotation (E-27).
CommandReply get_lag(Control& k, const Call& c) {
    return of_axis(k, c, [&](const Axis& a) {
        if (!a.model().ep) return refuse(quit::not_executable);
        return say_real(microsteps(a, a.shaft().lag(c.now)));
    });
}

CommandReply get_temperature(Control& k, const Call& c) {
    return of_axis(k, c,
                   [&](const Axis& a) { return a.model().ep ? say_real(a.state().outside.temperature) : refuse(quit::not_executable); });
}

/// Byte 0 (highest) power pack ready, 1 positive and 2 negative limit switch free, 3 axis status [L3164-3194].
CommandReply get_extended(Control& k, const Call& c) {
    return of_axis(k, c, [&](const Axis& a) {
        return say((a.state().outside.power_pack ? 0x01000000 : 0) + (a.switches().limit(true) ? 0 : 0x00010000) +
                   (a.switches().limit(false) ? 0 : 0x00000100) + a.shown().status().number);
    });
}

CommandReply get_system_flag(Control& k, const Call& c) {
    const auto v = k.views().flag(c.parameter);
    return v ? say(*v ? 1 : 0) : refuse(quit::no_flag);
}

CommandReply get_system_n(Control& k, const Call& c) {
    const auto v = k.views().integer(c.parameter);
    return v ? say(*v) : refuse(quit::no_n);
}

CommandReply get_system_r(Control& k, const Call& c) {
    const auto v = k.views().real(c.parameter);
    return v ? say_real(*v) : refuse(quit::no_r);
}

// --- ONLINE [L3260-3880] ---

CommandReply no_reference(Control& k, const Call& c) {
    return of_axis(k, c, [&](Axis& a) {
        if (a.running()) return refuse(quit::moves);
        a.set_referenced(true);
        k.settle(c.now);
        return say(0);
    });
}

CommandReply reference(Control& k, const Call& c) {
    if (!k.settings().has_axis(c.parameter)) return refuse(quit::no_axis);
    const std::uint16_t q = k.motions().start_task(axis_of(c), AxisTask{AxisTask::Kind::reference, 0, 1000, 1000, {}, true}, c.now);
    if (q != 0) return refuse(q);
    if (!k.freedoms().reference_at_once) return k.begin({Awaits::reference, axis_of(c)}, c.now);
    k.settle(c.now);
    return {0, true, {}, never};
}

/// 0A85 (G26 with 0), 0A86 (G29), 0A96 (G26 with a value). 0A85 sets the reference flag as G26 does (E-34).
CommandReply set_position(Control& k, const Call& c) {
    return of_axis(k, c, [&](Axis& a) {
        const double x = c.code == 0x0A85 ? 0 : c.data.value;
        if (!std::isfinite(x) || std::abs(x) > 1e9) return refuse(quit::value);
        if (a.running()) return refuse(quit::moves);
        if (c.code == 0x0A86) {
            a.set_position_g29(x);
        } else {
            a.set_position_g26(x, c.code != 0x0A85 || k.freedoms().null_references);
        }
        k.settle(c.now);
        return c.code == 0x0A85 ? say(0) : say_real(x);
    });
}

/// 0A87, 0A89: end of processing at the target. 0A90, 0A91, 0A94, 0A95: at once, with the start position.
CommandReply move(Control& k, const Call& c) {
    if (!k.settings().has_axis(c.parameter)) return refuse(quit::no_axis);
    const int n = axis_of(c);
    const bool relative = c.code == 0x0A89 || c.code == 0x0A91 || c.code == 0x0A95;
    const bool manual = c.code == 0x0A90 || c.code == 0x0A91;
    const double from = k.axis(n).shown().position(c.now);
    const std::uint16_t q = k.motions().start_move(n, c.data.value, relative, manual ? Task::manual : Task::position, c.now);
    if (q != 0) return refuse(q);
    if (c.code != 0x0A87 && c.code != 0x0A89) return say_real(from);
    return k.begin({Awaits::move, n}, c.now);
}

CommandReply set_speed(Control& k, const Call& c) {
    return of_axis(k, c, [&](Axis& a) {
        const auto& limits = k.settings().axis_limits(ap::traverse_speed);
        const double v = c.data.value;
        if (!(v >= static_cast<double>(limits.least)) || v > static_cast<double>(limits.largest)) return refuse(quit::value);
        if (a.running() && !a.model().ep) return refuse(quit::moves);  // while moving only on the EP [L3496]
        k.orders().of(axis_of(c)).overrides.speed = v;
        if (a.running() && a.traverse().task() == Task::position) a.traverse().change_speed(v, c.now);
        k.settle(c.now);
        return say_real(v);
    });
}

CommandReply set_acceleration(Control& k, const Call& c) {
    return of_axis(k, c, [&](Axis&) {
        const auto& limits = k.settings().axis_limits(ap::acceleration);
        const double v = c.data.value;
        if (!(v >= static_cast<double>(limits.least)) || v > static_cast<double>(limits.largest)) return refuse(quit::value);
        k.orders().of(axis_of(c)).overrides.acceleration = v;
        return say_real(v);
    });
}

CommandReply renew(Control& k, const Call& c) {
    return of_axis(k, c, [&](Axis& a) {
        a.traverse().renew(c.now);
        return say_real(a.shown().position(c.now));
    });
}

/// 0A93: end of processing at standstill; 0A9A: at once.
CommandReply abort_move(Control& k, const Call& c) {
    if (!k.settings().has_axis(c.parameter)) return refuse(quit::no_axis);
    k.axis(axis_of(c)).traverse().finish(c.now);
    k.settle(c.now);
    if (c.code == 0x0A93) return k.begin({Awaits::halt, axis_of(c)}, c.now);
    return say_real(k.axis(axis_of(c)).shown().position(c.now));
}

CommandReply axis_on(Control& k, const Call& c) {
    return of_axis(k, c, [&](Axis& a) {
        if (k.freedoms().switching == Switching::no_switch) return refuse(quit::not_executable);
        const std::uint16_t q = a.switch_on(c.now, k.status() == status::online);
        k.settle(c.now);
        if (q != 0) return refuse(q);
        return k.freedoms().axis_on_awaited ? k.begin({Awaits::power, axis_of(c)}, c.now) : say(0);
    });
}

CommandReply axis_off(Control& k, const Call& c) {
    return of_axis(k, c, [&](Axis& a) {
        if (k.freedoms().switching == Switching::no_switch) return refuse(quit::not_executable);
        a.switch_off(c.now);
        k.settle(c.now);
        return say(0);
    });
}

CommandReply measuring(Control& k, const Call& c) {
    return of_axis(k, c, [&](Axis& a) {
        const std::uint16_t q = c.code == 0x0AA0 ? a.begin_measuring() : a.end_measuring();
        k.settle(c.now);
        return q != 0 ? refuse(q) : say(0);
    });
}

/// Parameter 0: all axes.
template <class F>
CommandReply for_axes(Control& k, const Call& c, F&& f) {
    if (c.parameter != 0 && !k.settings().has_axis(c.parameter)) return refuse(quit::no_axis);
    for (int n = 1; k.settings().has_axis(n); ++n) {
        if (c.parameter == 0 || c.parameter == n) f(n);
    }
    return say(c.data.value);
}

CommandReply monitor_limits(Control& k, const Call& c) {
    if (c.parameter != 0 && !k.settings().has_axis(c.parameter)) return refuse(quit::no_axis);
    if (!is_bit(c.data)) return refuse(quit::value);
    return for_axes(k, c, [&](int n) { k.orders().of(n).limits_monitored = c.data.value != 0; });
}

/// Byte 3 condition, byte 2 kind of element, bytes 1 and 0 its number (E-31).
CommandReply set_condition(Control& k, const Call& c) {
    if (c.parameter != 0 && !k.settings().has_axis(c.parameter)) return refuse(quit::no_axis);
    const auto packed = static_cast<std::uint32_t>(whole(c.data));
    Condition x;
    x.type = static_cast<std::uint8_t>(packed >> 16);
    x.number = static_cast<std::int32_t>(packed & 0xFFFF);
    if (x.type == 1 && !k.signals().elements().inputs.has(x.number)) return refuse(quit::no_input);
    if (x.type == 2 && !k.signals().elements().outputs.has(x.number)) return refuse(quit::no_output);
    if (x.type == 3 && !k.signals().elements().flags.has(x.number)) return refuse(quit::no_flag);
    if (x.type < 1 || x.type > 3 || packed >> 24 > 1) return refuse(quit::value);
    x.value = packed >> 24 == 1;
    return for_axes(k, c, [&](int n) { k.orders().of(n).order(x); });
}

constexpr std::uint8_t H = gate::home;
constexpr std::uint8_t A = gate::automatic;
constexpr std::uint8_t O = gate::online;
constexpr std::uint8_t all = gate::all;

constexpr std::array<CommandRow, 66> rows{{
    {0x0600, "cmd_stop", A | O, false, stop},
    {0x0602, "cmd_start_auto", H | A, false, start_auto},
    {0x0603, "cmd_start_online", H | O, false, start_online},
    {0x0700, "cmd_set_system_parameter", H, false, set_system},
    {0x1700, "cmd_get_system_parameter", H, false, get_system},
    {0x1701, "cmd_get_system_parameter_max", H, false, get_system},
    {0x1702, "cmd_get_system_parameter_min", H, false, get_system},
    {0x0800, "cmd_set_axis_parameter", H, false, set_axis_parameter},
    {0x1800, "cmd_get_axis_parameter", H, false, get_axis_parameter},
    {0x1801, "cmd_get_axis_parameter_max", H, false, get_axis_parameter},
    {0x1802, "cmd_get_axis_parameter_min", H, false, get_axis_parameter},
    {0x1900, "cmd_get_single_input", all, false, get_input},
    {0x1901, "cmd_get_input_word", all, false, get_input_word},
    {0x0902, "cmd_put_single_output", all, false, put_output},
    {0x1902, "cmd_get_single_output", all, false, get_output},
    {0x0903, "cmd_put_output_word", all, false, put_output_word},
    {0x1903, "cmd_get_output_word", all, false, get_output_word},
    {0x0904, "cmd_put_single_flag", all, false, put_flag},
    {0x1904, "cmd_get_single_flag", all, false, get_flag},
    {0x0905, "cmd_put_flag_word", all, false, put_flag_word},
    {0x1905, "cmd_get_flag_word", all, false, get_flag_word},
    {0x0906, "cmd_put_int_reg", all, false, put_n},
    {0x1906, "cmd_get_int_reg", all, false, get_n},
    {0x0907, "cmd_put_float_reg", all, false, put_r},
    {0x1907, "cmd_get_float_reg", all, false, get_r},
    {0x0909, "cmd_reset_error", H, false, reset_error},
    {0x1909, "cmd_get_error", all, false, get_error},
    {0x190B, "cmd_get_state", all, false, get_state},
    {0x190C, "cmd_get_actual_pos", all, false, get_position},
    {0x190D, "cmd_get_actual_speed", all, false, get_speed},
    {0x190E, "cmd_get_actual_rotation_control_pos", all, false, get_encoder},
    {0x190F, "cmd_get_max_towfault", all, false, get_greatest_lag},
    {0x1910, "cmd_get_status_axis", all, false, get_axis_status},
    {0x1911, "cmd_get_status_all_axis", all, false, get_running},
    {0x1913, "cmd_get_axis_traverse_area_min", all, false, get_area_min},
    {0x1914, "cmd_get_axis_traverse_area_max", all, false, get_area_max},
    {0x1915, "cmd_get_axis_following_error", all, false, get_lag},
    {0x1920, "cmd_get_temperature", all, false, get_temperature},
    {0x1921, "cmd_get_extended_status_axis", all, false, get_extended},
    {0x1934, "cmd_send_system_flag", all, false, get_system_flag},
    {0x1935, "cmd_send_system_n_reg", all, false, get_system_n},
    {0x1937, "cmd_send_system_r_reg", all, false, get_system_r},
    {0x0A41, "cmd_abort_auto", A, false, cancel},
    {0x0A81, "cmd_abort_online", O, false, cancel},
    {0x0A83, "cmd_put_no_reference", O, true, no_reference},
    {0x0A84, "cmd_put_start_reference", O, true, reference},
    {0x0A85, "cmd_set_position_null", O, true, set_position},
    {0x0A86, "cmd_set_position", O, true, set_position},
    {0x0A87, "cmd_pos_axis_absolut", O, true, move},
    {0x0A89, "cmd_pos_axis_relativ", O, true, move},
    {0x0A8D, "cmd_set_speed_axis", O, true, set_speed},
    {0x0A8E, "cmd_set_acceleration_axis", O, true, set_acceleration},
    {0x0A90, "cmd_start_manuell_axis_absolut", O, true, move},
    {0x0A91, "cmd_start_manuell_axis_relativ", O, true, move},
    {0x0A92, "cmd_control_move_axis", O, true, renew},
    {0x0A93, "cmd_abort_move_axis", O, true, abort_move},
    {0x0A94, "cmd_start_axis_absolut", O, true, move},
    {0x0A95, "cmd_start_axis_relativ", O, true, move},
    {0x0A96, "cmd_put_axis_reference_on_position", O, true, set_position},
    {0x0A97, "cmd_on_axis", O, true, axis_on},
    {0x0A98, "cmd_off_axis", O, true, axis_off},
    {0x0A9A, "cmd_stop_axis_multi_cmd", O, true, abort_move},
    {0x0AA0, "cmd_set_measuring_mode", A | O, true, measuring},
    {0x0AA1, "cmd_reset_axis_measuring_mode", A | O, true, measuring},
    {0x0AA2, "cmd_put_limit_switch_monitoring_on_off", O, true, monitor_limits},  // modules have a bit of their own for it [L834]
    {0x0AA3, "cmd_put_condition_move_axis", O, false, set_condition},             // the module interface needs it [L820]
}};

}  // namespace

std::span<const CommandRow> command_rows() { return rows; }

const CommandRow* find_command(std::uint16_t code) {
    const auto it = std::ranges::find(rows, code, &CommandRow::code);
    return it == rows.end() ? nullptr : &*it;
}

}  // namespace axisgate::pacontrol::twin
