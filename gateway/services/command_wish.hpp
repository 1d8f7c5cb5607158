// A client's request for an axis, in the axis' unit and as it was given: the members of POST /axes/{name}/commands and of a streamed
// set-point as values. A door makes it once from its input; a command is made of it where the axis is known. Wrong values remain in it, so
// that all faults are reported together, by the code that knows the axis' unit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/services/fault.hpp"

namespace axisgate {

enum class CommandWord : std::uint8_t {
    missing,
    no_text,
    unknown,
    enable,
    disable,
    quick_stop,
    halt,
    reset_fault,
    home,
    set_position,
    move_absolute,
    move_relative,
    move_velocity
};
/// `unknown` for a text that is not a command.
[[nodiscard]] CommandWord command_word_named(std::string_view name) noexcept;

/// True for commands that stop an axis and leave it powered. Every door lets each of its clients give them.
[[nodiscard]] constexpr bool is_stop(CommandWord word) noexcept { return word == CommandWord::halt || word == CommandWord::quick_stop; }
[[nodiscard]] constexpr bool is_stop(std::string_view command) noexcept { return command == "halt" || command == "quick_stop"; }

/// A value in the place of a number that is not a number.
struct NoNumber {
    std::string written;  ///< as the client wrote it, for the message: "\"12\""
};
/// monostate: absent.
using WishedNumber = std::variant<std::monostate, double, NoNumber>;
enum class WishedFlag : std::uint8_t { no, yes, no_flag };

struct CommandWish {
    CommandWord word = CommandWord::missing;
    std::string name{};  ///< the word as it was given
    WishedNumber position{}, velocity{}, acceleration{}, deceleration{};
    WishedNumber method{}, hold_ms{};
    WishedFlag prepare = WishedFlag::no, renew = WishedFlag::no;
    std::vector<std::string> unknown{};  ///< given members that the command does not have

    [[nodiscard]] static CommandWish named(std::string_view name) {
        CommandWish wish;
        wish.word = command_word_named(name);
        wish.name = name;
        return wish;
    }
};

struct SetPointWish {
    std::optional<SetPoint::Mode> mode{};  ///< empty: absent, or not a mode
    WishedNumber value{}, velocity{}, acceleration{}, deceleration{};
    WishedNumber good_for_ms{};
    std::vector<std::string> unknown{};
};

/// True if a command has this member in addition to "command".
[[nodiscard]] bool takes(CommandWord word, std::string_view member) noexcept;
/// Members of a set-point.
[[nodiscard]] bool is_set_point_member(std::string_view member) noexcept;

struct ReadCommand {
    std::optional<CommandBody> body;  ///< only if there are no faults
    std::string name;                 ///< the command's word, if it was given
    std::vector<Fault> faults;
    bool range_only = false;  ///< every fault is a value outside its range
};
/// Requires `increments_per_unit` > 0. Positions are in the axis' unit, velocities in unit/s, accelerations in unit/s^2; each becomes the
/// nearest whole number of increments. Velocities and accelerations that would become 0 increments are refused. Nothing is clipped or
/// guessed: missing, unknown, infinite and too large values are faults.
[[nodiscard]] ReadCommand make_command(const CommandWish& wish, double increments_per_unit, std::string_view unit);

struct ReadSetPoint {
    std::optional<SetPoint> set_point;  ///< the caller sets axis, instant and origin; only if there are no faults
    std::vector<Fault> faults;
};
/// The value of a set-point for torque is in 1/1000 of the rated torque, without a unit.
[[nodiscard]] ReadSetPoint make_set_point(const SetPointWish& wish, double increments_per_unit, std::string_view unit);

}  // namespace axisgate
