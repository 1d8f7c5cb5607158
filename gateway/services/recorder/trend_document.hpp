// A period of trends as JSON and CSV, in the units of its axes. Times are ms since 1970, or RFC 3339.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/recorder/channels.hpp"
#include "gateway/services/recorder/trends.hpp"

namespace axisgate {

struct TrendAxis {
    std::string name, unit;
    double scale = 1;  ///< increments per unit
    TrendStretch stretch;
};

/// `unix_offset_ns` converts an instant to a time since 1970. `points` are some of trend_points.
[[nodiscard]] boost::json::object trend_document(const TrendAxis& axis, const std::vector<std::string>& points,
                                                 std::int64_t unix_offset_ns);
[[nodiscard]] std::string trend_csv(const std::vector<TrendAxis>& axes, const std::vector<std::string>& points,
                                    std::int64_t unix_offset_ns);

}  // namespace axisgate
