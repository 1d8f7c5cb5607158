// Command reader: the JSON of POST /axes/{name}/commands and of a streamed set-point, as wishes: made once, where JSON comes in.
// In: JSON objects. Out: wishes with all that was given, and what is wrong with it. Never refuses: command_wish does that.
#pragma once

#include <boost/json/object.hpp>
#include <string_view>

#include "gateway/services/command_wish.hpp"

namespace axisgate {

/// Members that its command takes become values; the others are named. A member that is null was not given.
[[nodiscard]] CommandWish read_command_wish(const boost::json::object& body);
/// {"axis": ..., "mode": "position" or "velocity" (in the unit, or unit/s) or "torque" (1/1000 of the rated one), "value": ..., and, if
/// wanted, "velocity", "acceleration", "deceleration" and "good_for_ms" (20 to 10000; 500)}.
[[nodiscard]] SetPointWish read_set_point_wish(const boost::json::object& body);

/// Where the axis is known already.
[[nodiscard]] inline ReadCommand read_command(const boost::json::object& body, double increments_per_unit, std::string_view unit) {
    return make_command(read_command_wish(body), increments_per_unit, unit);
}
[[nodiscard]] inline ReadSetPoint read_set_point(const boost::json::object& body, double increments_per_unit, std::string_view unit) {
    return make_set_point(read_set_point_wish(body), increments_per_unit, unit);
}

}  // namespace axisgate
