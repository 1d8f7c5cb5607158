// The result of a comparison as text for people and as JSON.
#pragma once

#include <boost/json/object.hpp>
#include <string>

#include "gateway/engine/comparison.hpp"
#include "gateway/services/parameters/drive_comparison.hpp"

namespace axisgate {

[[nodiscard]] std::string comparison_text(const ComparisonInput& input, const Comparison& comparison);
/// A drive on a line: a table of the values that differ, reply times, and what was adopted. `adopted_into`: the file; empty: none.
[[nodiscard]] std::string sweep_text(const DriveComparison& comparison, const std::string& adopted_into);
[[nodiscard]] boost::json::object comparison_json(const ComparisonInput& input, const Comparison& comparison);

}  // namespace axisgate
