// All parameters of an axis as CSV, and the reading of such a table into a plan of writes. A table is checked as a whole: if one line is
// wrong, nothing is planned, and every faulty line is reported.
#pragma once

#include <string>
#include <string_view>

#include "gateway/services/parameters/parameter_writes.hpp"

namespace axisgate {

[[nodiscard]] std::string parameters_csv(const ParameterPort& parameters, const AxisPlace& axis);
[[nodiscard]] Refusable<ParameterPlan> plan_of_csv(std::string_view csv, const ParameterPort& parameters, const AxisPlace& axis,
                                                   WriteBack include);

}  // namespace axisgate
