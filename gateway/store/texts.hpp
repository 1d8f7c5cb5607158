// Limits and checks texts and names for the store. A UTF-8 character is never cut in two.
#pragma once

#include <string>
#include <string_view>

#include "gateway/store/error.hpp"

namespace axisgate {

/// The text itself, or its beginning with " [...]", of at most `most` bytes.
[[nodiscard]] std::string cut(std::string_view text, std::size_t most);
/// Good if 1..max_name_bytes long and without control characters; otherwise `invalid` with the fault. `what`: "axis", "drive", ...
[[nodiscard]] StoreResult<> check_name(std::string_view what, std::string_view name);

}  // namespace axisgate
