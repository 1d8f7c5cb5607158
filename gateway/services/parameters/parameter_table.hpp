// Parameter table: all parameters of an axis as CSV, and a table of values for it.
// In: CSV text, what is known of the axis. Out: text; a plan of what is to be written, or every faulty line. A table is checked as a whole:
// of one with a wrong line nothing is planned. Never guesses a value.
#pragma once

#include <string>
#include <string_view>

#include "gateway/services/parameters/parameter_writes.hpp"

namespace axisgate {

[[nodiscard]] std::string parameters_csv(const ParameterPort& parameters, const AxisPlace& axis);
[[nodiscard]] Refusable<ParameterPlan> plan_of_csv(std::string_view csv, const ParameterPort& parameters, const AxisPlace& axis,
                                                   WriteBack include);

}  // namespace axisgate
