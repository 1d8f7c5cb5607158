// Parameter view: the parameters of an axis as the catalogue has them, with what the drive said, what was written, by whom and when; one
// read from the drive now; a value checked before it is written. In: names, filters, values. Out: places, documents, readings, refusals.
// A list needs no exchange. Never writes.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gateway/services/axis_place.hpp"
#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/parameters.hpp"
#include "gateway/services/refusal.hpp"

namespace axisgate {

struct ParameterPlace {
    AxisPlace axis;
    Point point;
    std::string id;
    [[nodiscard]] const Parameter& parameter() const { return *axis.catalogue->parameter(point); }
};
/// Refused: no such axis, or no such parameter. `hints`: of an array where one element is meant, its elements are told.
[[nodiscard]] Refusable<ParameterPlace> find_parameter(const SitePort& sites, const std::string& axis, const std::string& parameter,
                                                       bool hints = true);

[[nodiscard]] const StoredParameter* stored_of(const std::vector<StoredParameter>& list, std::string_view id);

struct ParameterFilter {
    std::optional<std::string_view> group, array;
    std::int64_t first = 0;  ///< of the array's elements
};
/// Short arrays element by element; a long one is an entry unless it is the one that is asked for.
[[nodiscard]] Refusable<boost::json::array> parameter_list(const ParameterPort& parameters, const AxisPlace& axis,
                                                           const ParameterFilter& filter);
/// One parameter, with so many of its last writes; unit and range are those that hold now.
[[nodiscard]] boost::json::object parameter_now(const ParameterPort& parameters, const ParameterPlace& place, const LiveParameter& live,
                                                std::string_view text, std::int64_t history);
/// The writes of one parameter, newest first: at, who, door, old, new.
[[nodiscard]] boost::json::array parameter_history(const ParameterPort& parameters, const ParameterPlace& place, std::size_t limit);

struct ParameterReading {
    LiveParameter live;  ///< stale: the drive does not answer, this is what it said last
    std::string text;    ///< why it is not what the drive says now
};
/// Asks the drive. `then`: the reading, or the result that says why there is none.
Ticket read_parameter_now(AxisPort& axes, const ClockPort& clock, const ParameterPort& parameters, const ParameterPlace& place,
                          Origin origin, std::function<void(std::variant<ParameterReading, Result>)> then);

/// {"value": ...} as the value to be written, in the parameter's own type and range; what hangs on another parameter by what that is now.
[[nodiscard]] Refusable<Value> value_to_write(const ParameterPort& parameters, const ParameterPlace& place,
                                              const boost::json::object& body);

}  // namespace axisgate
