// Reads the one value that a condition of a recipe names, by its row of the table of points, as the axis' document shows it. No document is
// made, because a wait reads every 20 ms.
#pragma once

#include <cstdint>

#include "gateway/axis/points.hpp"
#include "gateway/core/value.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// Unknown if the row is not a point of recipes, or its value is not known now. For a recipe, values of an axis that does not answer, or
/// that are too old, are unknown. `age_ms` is that of the picture.
[[nodiscard]] Value recipe_point(const AxisPointRow& row, const AxisPicture& picture, const AxisSpec& spec, std::int64_t age_ms);

}  // namespace axisgate
