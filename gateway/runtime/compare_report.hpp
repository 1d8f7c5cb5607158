// The result of a comparison as text for people and as JSON.
#pragma once

#include <boost/json/object.hpp>
#include <string>

#include "gateway/engine/comparison.hpp"

namespace axisgate {

[[nodiscard]] std::string comparison_text(const ComparisonInput& input, const Comparison& comparison);
[[nodiscard]] boost::json::object comparison_json(const ComparisonInput& input, const Comparison& comparison);

}  // namespace axisgate
