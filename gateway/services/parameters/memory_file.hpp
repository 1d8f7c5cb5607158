// Twins' non-volatile memories as JSON, by address: {"5": {"AC": 5000, ...}}. Numbers, booleans and texts keep their types.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "gateway/core/twin.hpp"

namespace axisgate {

[[nodiscard]] std::string memories_to_json(const std::map<std::string, NonVolatile>& memories);
/// Empty if read, otherwise the fault in the text.
[[nodiscard]] std::string memories_from_json(std::string_view text, std::map<std::string, NonVolatile>& memories);

}  // namespace axisgate
