// Memory file: twins' non-volatile memories as JSON, by address: {"5": {"AC": 5000, ...}}.
// In: memories or text. Out: the other. Never guesses types: numbers, truth values and texts are kept as they are.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "gateway/core/twin.hpp"

namespace axisgate {

[[nodiscard]] std::string memories_to_json(const std::map<std::string, NonVolatile>& memories);
/// Empty: read. Else what is wrong with the text.
[[nodiscard]] std::string memories_from_json(std::string_view text, std::map<std::string, NonVolatile>& memories);

}  // namespace axisgate
