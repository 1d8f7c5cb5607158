// The parameters of an axis: catalogue, the drive's last report, the last write with client and time; one of them read from the drive now;
// a value checked before it is written. A list needs no exchange. Nothing is written here.
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
/// Refused if the axis or the parameter does not exist. `hints`: if an element of an array is required, the text names the elements.
[[nodiscard]] Refusable<ParameterPlace> find_parameter(const SitePort& sites, const std::string& axis, const std::string& parameter,
                                                       bool hints = true);

[[nodiscard]] const StoredParameter* stored_of(const std::vector<StoredParameter>& list, std::string_view id);

struct ParameterFilter {
    std::optional<std::string_view> group, array;
    std::int64_t first = 0;  ///< of the array's elements
};
/// Short arrays element by element; a long one is one entry unless it is the requested one.
[[nodiscard]] Refusable<boost::json::array> parameter_list(const ParameterPort& parameters, const AxisPlace& axis,
                                                           const ParameterFilter& filter);
/// One parameter, with this number of its last writes; unit and range are those that apply now.
[[nodiscard]] boost::json::object parameter_now(const ParameterPort& parameters, const ParameterPlace& place, const LiveParameter& live,
                                                std::string_view text, std::int64_t history);
/// The writes of one parameter, newest first: at, who, door, old, new.
[[nodiscard]] boost::json::array parameter_history(const ParameterPort& parameters, const ParameterPlace& place, std::size_t limit);

struct ParameterReading {
    LiveParameter live;  ///< stale: the drive does not answer, and this is its last report
    std::string text;    ///< the reason why it is not the drive's present value
};
/// Asks the drive. `then` gets the reading, or the result with the reason why there is none.
Ticket read_parameter_now(AxisPort& axes, const ClockPort& clock, const ParameterPort& parameters, const ParameterPlace& place,
                          Origin origin, std::function<void(std::variant<ParameterReading, Result>)> then);

/// The value in {"value": ...}, in the parameter's own type and range; a dependency on another parameter is evaluated with its present
/// value.
[[nodiscard]] Refusable<Value> value_to_write(const ParameterPort& parameters, const ParameterPlace& place,
                                              const boost::json::object& body);

}  // namespace axisgate
