// Numbers by which the twin says what is wrong: command errors, that a command is refused or ended with, and system errors.
// In: nothing. Out: constants. Never says which of them holds when: that is the axis' and the control's.
#pragma once

#include <cstdint>

namespace axisgate::pacontrol::twin {

/// Command error numbers that an axis gives [L4036-4076].
namespace quit {
inline constexpr std::uint16_t ok = 0;
inline constexpr std::uint16_t unknown_command = 0x13;
inline constexpr std::uint16_t inadmissible = 0x14;
inline constexpr std::uint16_t not_executable = 0x15;
inline constexpr std::uint16_t no_axis = 0x20;
inline constexpr std::uint16_t no_axis_parameter = 0x21;
inline constexpr std::uint16_t no_system_parameter = 0x22;
inline constexpr std::uint16_t no_input = 0x23;
inline constexpr std::uint16_t no_output = 0x24;
inline constexpr std::uint16_t no_flag = 0x25;
inline constexpr std::uint16_t no_n = 0x26;
inline constexpr std::uint16_t no_r = 0x27;
inline constexpr std::uint16_t value = 0x29;
inline constexpr std::uint16_t moves = 0x2A;
inline constexpr std::uint16_t no_reference = 0x2B;
inline constexpr std::uint16_t no_external_stop = 0x2C;
inline constexpr std::uint16_t not_ready = 0x2E;
inline constexpr std::uint16_t not_initialised = 0x34;
inline constexpr std::uint16_t path_too_long = 0x36;
inline constexpr std::uint16_t switched_off = 0x37;
inline constexpr std::uint16_t displaced = 0x38;
inline constexpr std::uint16_t profibus_address = 0x39;
inline constexpr std::uint16_t limit_switch = 0x40;
inline constexpr std::uint16_t outside_range = 0x41;
inline constexpr std::uint16_t no_measuring = 0x6C;
}  // namespace quit

/// System error numbers: 205, 525, 529 and 560 are the manual's [L335, L716, L2825, L3812]; for the negative switch, the following error,
/// the power pack and a traverse that a program cannot start it names none, so these four are the model's own.
namespace error {
inline constexpr std::uint16_t rotary_switches = 205;
inline constexpr std::uint16_t no_reference = 525;
inline constexpr std::uint16_t limit_positive = 529;
inline constexpr std::uint16_t limit_negative = 530;
inline constexpr std::uint16_t following_error = 531;
inline constexpr std::uint16_t power_pack = 532;
inline constexpr std::uint16_t program_move = 533;
inline constexpr std::uint16_t no_encoder_edge = 560;
}  // namespace error

}  // namespace axisgate::pacontrol::twin
