// Commands: the tables.
// In: codes. Out: rows and words. Gates and data: the manual's chapters 5.2.1 to 5.2.6; names of errors and statuses: chapters 6.4 and 6.5.
// Never translates a word away: a user finds the manual's terms.
#include "adapters/pacontrol/wire_commands.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr auto no = Carries::nothing;
constexpr auto bit = Carries::bit, word = Carries::word, integer = Carries::integer, real = Carries::real;
constexpr auto none = Takes::nothing;
constexpr auto element = Takes::element, axis = Takes::axis, group = Takes::axis_or_all, ap = Takes::axis_parameter,
               sp = Takes::system_parameter;

// code, name, parameter, data, answer, home only, ONLINE only, repeatable
constexpr std::array<CommandInfo, 66> table{{
    {0x0600, "cmd_stop", none, no, no, false, false, true},
    {0x0602, "cmd_start_auto", none, no, no, false, false, false},
    {0x0603, "cmd_start_online", none, no, no, false, false, false},
    {0x0700, "cmd_set_system_parameter", sp, integer, integer, true, false, true},
    {0x1700, "cmd_get_system_parameter", sp, no, integer, true, false, true},
    {0x1701, "cmd_get_system_parameter_max", sp, no, integer, true, false, true},
    {0x1702, "cmd_get_system_parameter_min", sp, no, integer, true, false, true},
    {0x0800, "cmd_set_axis_parameter", ap, real, real, true, false, true},
    {0x1800, "cmd_get_axis_parameter", ap, no, real, true, false, true},
    {0x1801, "cmd_get_axis_parameter_max", ap, no, real, true, false, true},
    {0x1802, "cmd_get_axis_parameter_min", ap, no, real, true, false, true},
    {0x1900, "cmd_get_single_input", element, no, bit, false, false, true},
    {0x1901, "cmd_get_input_word", element, no, word, false, false, true},
    {0x0902, "cmd_put_single_output", element, bit, bit, false, false, true},
    {0x1902, "cmd_get_single_output", element, no, bit, false, false, true},
    {0x0903, "cmd_put_output_word", element, word, word, false, false, true},
    {0x1903, "cmd_get_output_word", element, no, word, false, false, true},
    {0x0904, "cmd_put_single_flag", element, bit, bit, false, false, true},
    {0x1904, "cmd_get_single_flag", element, no, bit, false, false, true},
    {0x0905, "cmd_put_flag_word", element, word, word, false, false, true},
    {0x1905, "cmd_get_flag_word", element, no, word, false, false, true},
    {0x0906, "cmd_put_int_reg", element, integer, integer, false, false, true},
    {0x1906, "cmd_get_int_reg", element, no, integer, false, false, true},
    {0x0907, "cmd_put_float_reg", element, real, real, false, false, true},
    {0x1907, "cmd_get_float_reg", element, no, real, false, false, true},
    {0x0909, "cmd_reset_error", none, no, integer, true, false, false},
    {0x1909, "cmd_get_error", none, no, integer, false, false, true},
    {0x190B, "cmd_get_state", none, no, integer, false, false, true},
    {0x190C, "cmd_get_actual_pos", axis, no, real, false, false, true},
    {0x190D, "cmd_get_actual_speed", axis, no, real, false, false, true},
    {0x190E, "cmd_get_actual_rotation_control_pos", axis, no, real, false, false, true},
    {0x190F, "cmd_get_max_towfault", axis, no, real, false, false, true},
    {0x1910, "cmd_get_status_axis", axis, no, integer, false, false, true},
    {0x1911, "cmd_get_status_all_axis", none, no, integer, false, false, true},
    {0x1913, "cmd_get_axis_traverse_area_min", axis, no, real, false, false, true},
    {0x1914, "cmd_get_axis_traverse_area_max", axis, no, real, false, false, true},
    {0x1915, "cmd_get_axis_following_error", axis, no, real, false, false, true},
    {0x1920, "cmd_get_temperature", axis, no, real, false, false, true},
    {0x1921, "cmd_get_extended_status_axis", axis, no, integer, false, false, true},
    {0x1934, "cmd_send_system_flag", element, no, bit, false, false, true},
    {0x1935, "cmd_send_system_n_reg", element, no, integer, false, false, true},
    {0x1937, "cmd_send_system_r_reg", element, no, real, false, false, true},
    {0x0A41, "cmd_abort_auto", none, no, no, false, false, false},
    {0x0A81, "cmd_abort_online", none, no, no, false, true, false},
    {0x0A83, "cmd_put_no_reference", axis, no, no, false, true, true},
    {0x0A84, "cmd_put_start_reference", axis, no, no, false, true, false},
    {0x0A85, "cmd_set_position_null", axis, no, no, false, true, false},
    {0x0A86, "cmd_set_position", axis, real, real, false, true, false},
    {0x0A87, "cmd_pos_axis_absolut", axis, real, real, false, true, false},
    {0x0A89, "cmd_pos_axis_relativ", axis, real, real, false, true, false},
    {0x0A8D, "cmd_set_speed_axis", axis, real, real, false, true, true},
    {0x0A8E, "cmd_set_acceleration_axis", axis, real, real, false, true, true},
    {0x0A90, "cmd_start_manuell_axis_absolut", axis, real, real, false, true, false},
    {0x0A91, "cmd_start_manuell_axis_relativ", axis, real, real, false, true, false},
    {0x0A92, "cmd_control_move_axis", axis, no, real, false, true, true},
    {0x0A93, "cmd_abort_move_axis", axis, no, real, false, true, true},
    {0x0A94, "cmd_start_axis_absolut", axis, real, real, false, true, false},
    {0x0A95, "cmd_start_axis_relativ", axis, real, real, false, true, false},
    {0x0A96, "cmd_put_axis_reference_on_position", axis, real, real, false, true, false},
    {0x0A97, "cmd_on_axis", axis, no, no, false, true, true},
    {0x0A98, "cmd_off_axis", axis, no, no, false, true, true},
    {0x0A9A, "cmd_stop_axis_multi_cmd", axis, no, real, false, true, true},
    {0x0AA0, "cmd_set_measuring_mode", axis, no, no, false, false, true},         // also in AUTOMATIC [L3774]
    {0x0AA1, "cmd_reset_axis_measuring_mode", axis, no, no, false, false, true},  // where it can be begun it can be ended
    {0x0AA2, "cmd_put_limit_switch_monitoring_on_off", group, bit, no, false, true, true},
    {0x0AA3, "cmd_put_condition_move_axis", group, integer, no, false, true, true},
}};

struct Text {
    int number;
    std::string_view text;
};
constexpr std::array errors{
    Text{0x00, "no error"},
    Text{0x10, "check wrong"},
    Text{0x11, "wrong sequence set-up"},
    Text{0x12, "wrong sequence beginning"},
    Text{0x13, "unknown command"},
    Text{0x14, "inadmissible command in this operating mode"},
    Text{0x15, "command not executable"},
    Text{0x1A, "update: EPROM programming"},
    Text{0x1B, "update: byte count"},
    Text{0x1C, "update: data record"},
    Text{0x1D, "update: record check"},
    Text{0x1E, "update: erase"},
    Text{0x1F, "update: address"},
    Text{0x20, "axis number unknown"},
    Text{0x21, "axis parameter unknown"},
    Text{0x22, "system parameter unknown"},
    Text{0x23, "inadmissible input"},
    Text{0x24, "inadmissible output"},
    Text{0x25, "inadmissible flag"},
    Text{0x26, "inadmissible N register"},
    Text{0x27, "inadmissible R register"},
    Text{0x28, "inadmissible task number"},
    Text{0x29, "value outside range"},
    Text{0x2A, "axis still moves"},
    Text{0x2B, "no reference point"},
    Text{0x2C, "external stop not defined"},
    Text{0x2D, "inadmissible AD converter"},
    Text{0x2E, "axis not ready"},
    Text{0x2F, "not a servoTEC axis"},
    Text{0x30, "no connection to servoTEC axis"},
    Text{0x31, "not all axes initialised"},
    Text{0x32, "error during initialisation"},
    Text{0x33, "errors in axis parameters"},
    Text{0x34, "not initialised"},
    Text{0x35, "access to SLAVE axis"},
    Text{0x36, "axis path too long"},
    Text{0x37, "axis not switched on (IDLE or SAFE)"},
    Text{0x38, "axis displaced too much"},
    Text{0x39, "Profibus address cannot be taken over"},
    Text{0x3A, "parameter inconsistent"},
    Text{0x3B, "Gantry slave cannot be traversed"},
    Text{0x40, "limit switch actuated"},
    Text{0x41, "position outside range"},
    Text{0x50, "program exists"},
    Text{0x51, "program syntax"},
    Text{0x52, "program not available"},
    Text{0x53, "program name exists"},
    Text{0x60, "traverse speed too high"},
    Text{0x61, "traverse speed too low"},
    Text{0x62, "reference speed too high"},
    Text{0x63, "reference speed too low"},
    Text{0x64, "manual speed too high"},
    Text{0x65, "manual speed too low"},
    Text{0x66, "creep speed too high"},
    Text{0x67, "creep speed too low"},
    Text{0x68, "start-stop speed too high"},
    Text{0x69, "start-stop speed too low"},
    Text{0x6A, "acceleration too high"},
    Text{0x6B, "acceleration too low"},
    Text{0x6C, "measuring mode not admissible for this axis"},
    Text{0x6D, "traverse increments above 31 bits"},
};
constexpr std::array statuses{
    Text{0, "no communication, not initialised"},
    Text{1, "home position"},
    Text{2, "manual by front panel"},
    Text{3, "manual by front panel, axis moves"},
    Text{9, "home position with system error"},
    Text{10, "AUTOMATIC started"},
    Text{11, "AUTOMATIC"},
    Text{12, "AUTOMATIC, STOP recognised"},
    Text{13, "AUTOMATIC, STOP program"},
    Text{15, "AUTOMATIC stopped"},
    Text{16, "AUTOMATIC, START-AFTER-STOP program"},
    Text{17, "AUTOMATIC, malfunction recognised"},
    Text{18, "AUTOMATIC, MALFUNCTION program"},
    Text{19, "AUTOMATIC stopped with malfunction"},
    Text{20, "manual by WINPAC"},
    Text{30, "ONLINE started"},
    Text{31, "ONLINE"},
    Text{32, "ONLINE, STOP recognised"},
    Text{35, "ONLINE stopped"},
    Text{37, "ONLINE, malfunction recognised"},
    Text{39, "ONLINE stopped with malfunction"},
};
}  // namespace

std::span<const CommandInfo> all_commands() noexcept { return table; }

const CommandInfo* command_info(std::uint16_t code) noexcept {
    const auto it = std::ranges::find(table, code, &CommandInfo::code);
    return it == table.end() ? nullptr : &*it;
}

Request request_for(std::uint16_t code, std::uint32_t parameter, std::string data) {
    const CommandInfo* c = command_info(code);
    return {code, parameter, c && (c->data == Carries::real || c->answer == Carries::real), std::move(data)};
}

const CommandInfo* command_named(std::string_view name) noexcept {
    for (const CommandInfo& c : table) {
        if (c.name == name || c.name.substr(4) == name || fmt::format("{:04X}", c.code) == name) return &c;
    }
    return nullptr;
}

std::string quit_text(std::uint16_t number) {
    const auto it = std::ranges::find(errors, static_cast<int>(number), &Text::number);
    if (it != errors.end()) return std::string(it->text);
    if (number >= 0xFA && number <= 0x106) return "AS-i master error";
    return fmt::format("command error {}, which the manual does not name", number);
}

std::string describe_quit(std::uint16_t number) { return fmt::format("command error {} ({:02X}h): {}", number, number, quit_text(number)); }

std::string status_text(int s) {
    const auto it = std::ranges::find(statuses, s, &Text::number);
    return fmt::format("{} ({})", s, it == statuses.end() ? "no meaning given" : it->text);
}

std::string describe(const Request& r) {
    const CommandInfo* c = command_info(r.code);
    if (!c) return fmt::format("{:04X} unknown command, parameter {}, data {}", r.code, r.parameter, r.data);
    std::string s = fmt::format("{:04X} {}", r.code, c->name);
    switch (c->parameter) {
        case Takes::nothing:
            break;
        case Takes::element:
        case Takes::system_parameter:
            s += fmt::format(" {}", r.parameter);
            break;
        case Takes::axis:
        case Takes::axis_or_all:
            s += r.parameter == 0 && c->parameter == Takes::axis_or_all ? std::string(" all axes") : fmt::format(" axis {}", r.parameter);
            break;
        case Takes::axis_parameter:
            s += fmt::format(" axis {} parameter {}", r.parameter >> 8, r.parameter & 0xFF);
            break;
    }
    if (c->data != Carries::nothing) s += " = " + r.data;
    return s;
}

std::string describe(const Reply& r) {
    std::string s = r.quit != 0 ? describe_quit(r.quit) : std::string("done");
    if (r.quit == 0 && !r.end) s = "being processed";
    s += fmt::format(", {}", r.data);
    if (r.quit != 0 && !r.end) s += ", being processed";
    s += fmt::format("; operating status {}", status_text(r.status));
    if (r.error != 0) s += fmt::format("; PA-CONTROL error E{}", r.error);
    return s;
}

}  // namespace axisgate::pacontrol
