// Recipe point: the one value that a condition of a recipe looks at, by its row of the table of points.
// In: a row, a picture. Out: a value, as the axis' document shows it. Never makes a document: a wait looks each 20 ms.
#pragma once

#include <cstdint>

#include "gateway/axis/points.hpp"
#include "gateway/core/value.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// Unknown: it is no point of recipes, or not known now. What is said of an axis that does not answer, or was said too long ago, is not
/// known to a recipe. `age_ms`: of the picture.
[[nodiscard]] Value recipe_point(const AxisPointRow& row, const AxisPicture& picture, const AxisSpec& spec, std::int64_t age_ms);

}  // namespace axisgate
