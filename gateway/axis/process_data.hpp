// Process data by point: a number into the member of the standard map's set-points that a point of an axis stands for.
// In: a point, a number. Out: the member set. Shared by all that write set-points by name: own register maps, recipes.
#pragma once

#include <cstdint>

#include "gateway/core/command.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {

/// False: the point is none that can be set so, or the number does not fit its register.
[[nodiscard]] bool put_process_data(ProcessData& into, AxisPoint point, std::int64_t number);

}  // namespace axisgate
