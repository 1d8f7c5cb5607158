// Axis metrics: what the axes are doing, for /metrics.
// In: the site, the pictures of its axes, the moment. Out: Prometheus text. Never invents a number: what is not known has no line.
#pragma once

#include <span>
#include <string>

#include "gateway/axis/image.hpp"
#include "gateway/axis/points.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

/// `pictures`: by index in site.site.axes. Positions and speeds are in the axis' unit, as over the API.
[[nodiscard]] std::string axis_metrics(const SiteState& site, std::span<const AxisPicture> pictures, Instant now,
                                       AxisPointRows rows = axis_point_table);

}  // namespace axisgate
