// Sets the set-point of the standard map that a point of an axis stands for. Shared by all writers of set-points by name: user register
// maps and recipes.
#pragma once

#include <cstdint>

#include "gateway/core/command.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {

/// Returns false if the point cannot be set in this way, or the number does not fit its register.
[[nodiscard]] bool put_process_data(ProcessData& into, AxisPoint point, std::int64_t number);

}  // namespace axisgate
