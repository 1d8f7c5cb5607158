// Commands: the 66 command codes, the command errors (QUIT), and the operating statuses, as chapters 5 and 6 of the manual name them.
// In: numbers. Out: names, what parameter and data a code takes, whether it may be sent twice, in which mode it may be given.
// Never holds a state.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "adapters/pacontrol/wire.hpp"

namespace axisgate::pacontrol {

namespace code {
inline constexpr std::uint16_t stop = 0x0600, start_auto = 0x0602, start_online = 0x0603, put_output = 0x0902, get_input = 0x1900,
                               reset_error = 0x0909, get_state = 0x190B, position = 0x190C, speed = 0x190D, status_axis = 0x1910,
                               running_axes = 0x1911, area_min = 0x1913, area_max = 0x1914, following_error = 0x1915,
                               extended_status = 0x1921, system_flag = 0x1934, put_axis_parameter = 0x0800, axis_parameter = 0x1800,
                               abort_auto = 0x0A41, abort_online = 0x0A81, no_reference = 0x0A83, reference = 0x0A84,
                               position_null = 0x0A85, set_position = 0x0A86, move_absolute_wait = 0x0A87, move_relative_wait = 0x0A89,
                               set_speed = 0x0A8D, set_acceleration = 0x0A8E, manual_absolute = 0x0A90, manual_relative = 0x0A91,
                               manual_renew = 0x0A92, abort_move = 0x0A93, move_absolute = 0x0A94, move_relative = 0x0A95,
                               reference_here = 0x0A96, axis_on = 0x0A97, axis_off = 0x0A98, stop_axis = 0x0A9A, measuring_on = 0x0AA0,
                               measuring_off = 0x0AA1, limit_switches = 0x0AA2, condition = 0x0AA3;
}  // namespace code

/// SM51 is "axis 1 is referenced" [L3935].
inline constexpr std::uint32_t referenced_flag = 50;

enum class Takes : std::uint8_t { nothing, element, axis, axis_or_all, axis_parameter, system_parameter };
enum class Carries : std::uint8_t { nothing, bit, word, integer, real };

struct CommandInfo {
    std::uint16_t code = 0;
    std::string_view name;  ///< the manual's, misspellings mended
    Takes parameter = Takes::nothing;
    Carries data = Carries::nothing;
    Carries answer = Carries::nothing;
    bool home_only = false;  ///< system and axis parameters, 0909: only in home position [L394-L404]
    bool online_only = false;
    bool repeatable = true;  ///< executed twice it does what it does once: may be sent again when no answer came
};
[[nodiscard]] std::span<const CommandInfo> all_commands() noexcept;
[[nodiscard]] const CommandInfo* command_info(std::uint16_t code) noexcept;
/// By name, by name without `cmd_`, or by its four hex digits.
[[nodiscard]] const CommandInfo* command_named(std::string_view name) noexcept;

/// A request whose type is the table's; an unknown code is one of integers.
[[nodiscard]] Request request_for(std::uint16_t code, std::uint32_t parameter = 0, std::string data = "0");

/// Command errors that the adapter acts upon [L4023-L4113].
namespace quit {
inline constexpr std::uint16_t check_wrong = 0x10, frame_order = 0x11, frame_begin = 0x12, unknown_command = 0x13, inadmissible = 0x14,
                               not_executable = 0x15, axis_unknown = 0x20, input_unknown = 0x23, axis_moves = 0x2A, no_reference = 0x2B,
                               not_switched_on = 0x37, no_external_stop = 0x2C, not_initialised = 0x34;
}
/// The manual's words for a command error; "command error N, which the manual does not name" for others.
[[nodiscard]] std::string quit_text(std::uint16_t number);
/// "QUIT 44 (2Ch): external stop not defined"
[[nodiscard]] std::string describe_quit(std::uint16_t number);

/// Operating statuses [L3991-L4019].
namespace status {
inline constexpr std::uint8_t none = 0, home = 1, home_error = 9, auto_started = 10, auto_run = 11, auto_stopped = 15,
                              auto_malfunction = 17, auto_stopped_malfunction = 19, online_started = 30, online = 31, online_stop = 32,
                              online_stopped = 35, online_malfunction = 37, online_stopped_malfunction = 39;
}
[[nodiscard]] constexpr bool is_home(int s) noexcept { return s == 1 || s == 9; }
[[nodiscard]] constexpr bool is_manual(int s) noexcept { return s == 2 || s == 3 || s == 20; }
[[nodiscard]] constexpr bool is_automatic(int s) noexcept { return s >= 10 && s <= 19; }
[[nodiscard]] constexpr bool is_online(int s) noexcept { return s >= 30 && s <= 39; }
[[nodiscard]] constexpr bool is_malfunction(int s) noexcept { return s == 9 || (s >= 17 && s <= 19) || s == 37 || s == 39; }
/// "31 (ONLINE)"
[[nodiscard]] std::string status_text(int status);

/// One line for people.
[[nodiscard]] std::string describe(const Request& request);
[[nodiscard]] std::string describe(const Reply& reply);

}  // namespace axisgate::pacontrol
