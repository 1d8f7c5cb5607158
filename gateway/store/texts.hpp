// Small helpers of the store for texts and names.
// In: texts from doors, drives and people. Out: the same within the store's bounds, or why not.
// Never cuts a UTF-8 character in two.
#pragma once

#include <string>
#include <string_view>

#include "gateway/store/error.hpp"

namespace axisgate {

/// The text itself, or its beginning with " [...]", of at most `most` bytes.
[[nodiscard]] std::string cut(std::string_view text, std::size_t most);
/// Good if 1..max_name_bytes long and without control characters; else `invalid` with what is wrong. `what`: "axis", "drive", ...
[[nodiscard]] StoreResult<> check_name(std::string_view what, std::string_view name);

}  // namespace axisgate
