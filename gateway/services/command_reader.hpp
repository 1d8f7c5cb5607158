// Command reader: the body of POST /axes/{name}/commands into a CommandBody: units into whole increments, every fault at once.
// In: a JSON object and the axis' scale. Out: a command, or faults with pointers and remedies.
// Never clips, never guesses: what is missing, unknown, not finite or too large is refused.
#pragma once

#include <boost/json/object.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/services/fault.hpp"

namespace axisgate {

struct ReadCommand {
    std::optional<CommandBody> body;  ///< only if there are no faults
    std::string name;                 ///< the command's word, as far as it was given
    std::vector<Fault> faults;
    bool range_only = false;  ///< every fault is a value outside its range
};

/// A word of POST /axes/{name}/commands that stops an axis and leaves it powered. Every door lets whoever it lets in give one.
[[nodiscard]] constexpr bool is_stop(std::string_view command) noexcept { return command == "halt" || command == "quick_stop"; }

/// `increments_per_unit` > 0. Positions are in the axis' unit, velocities in unit/s, accelerations in unit/s^2; each becomes the nearest
/// whole number of increments. Velocities and accelerations that would become 0 increments are refused.
[[nodiscard]] ReadCommand read_command(const boost::json::object& body, double increments_per_unit, std::string_view unit);

struct ReadSetPoint {
    std::optional<SetPoint> set_point;  ///< axis, instant and origin are the caller's; only if there are no faults
    std::vector<Fault> faults;
};
/// {"axis": ..., "mode": "position" or "velocity" (in the unit, or unit/s) or "torque" (1/1000 of the rated one), "value": ..., and, if
/// wanted, "velocity", "acceleration", "deceleration" and "good_for_ms" (20 to 10000; 500)}.
[[nodiscard]] ReadSetPoint read_set_point(const boost::json::object& body, double increments_per_unit, std::string_view unit);

}  // namespace axisgate
