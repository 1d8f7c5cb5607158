// The values of the axes for /metrics. An unknown value has no line.
#pragma once

#include <span>
#include <string>

#include "gateway/axis/image.hpp"
#include "gateway/axis/points.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

/// `pictures` by index in site.site.axes. Positions and speeds are in the axis' unit, as in the API.
[[nodiscard]] std::string axis_metrics(const SiteState& site, std::span<const AxisPicture> pictures, Instant now,
                                       AxisPointRows rows = axis_point_table);

}  // namespace axisgate
