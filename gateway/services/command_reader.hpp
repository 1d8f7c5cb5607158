// Converts the JSON of POST /axes/{name}/commands and of a streamed set-point to a wish, once, at the place where JSON arrives. A wish
// contains all given values, including wrong ones; command_wish refuses them.
#pragma once

#include <boost/json/object.hpp>
#include <string_view>

#include "gateway/services/command_wish.hpp"

namespace axisgate {

/// Members of the command become values; other members are listed by name. A member that is null counts as absent.
[[nodiscard]] CommandWish read_command_wish(const boost::json::object& body);
/// {"axis": ..., "mode": "position" or "velocity" (in the unit, or unit/s) or "torque" (1/1000 of the rated one), "value": ..., and
/// optionally "velocity", "acceleration", "deceleration" and "good_for_ms" (20 to 10000; 500)}.
[[nodiscard]] SetPointWish read_set_point_wish(const boost::json::object& body);

/// Both steps, for callers that know the axis already.
[[nodiscard]] inline ReadCommand read_command(const boost::json::object& body, double increments_per_unit, std::string_view unit) {
    return make_command(read_command_wish(body), increments_per_unit, unit);
}
[[nodiscard]] inline ReadSetPoint read_set_point(const boost::json::object& body, double increments_per_unit, std::string_view unit) {
    return make_set_point(read_set_point_wish(body), increments_per_unit, unit);
}

}  // namespace axisgate
