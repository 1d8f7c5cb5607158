// The addresses of a scan on lines whose drives have numbers: either a plan, or why the request is not valid. A plan has at most `last -
// first + 1` addresses.
#pragma once

#include <string>
#include <string_view>

#include "gateway/core/family.hpp"

namespace axisgate::drive {

/// All numbers from `wish.from` (default `first`) to `wish.to` (default `last`), in order. `check` returns why a text is not an address;
/// empty if it is one.
[[nodiscard]] ScanPlan scan_range(const ScanWish& wish, int first, int last, std::string (*check)(std::string_view));

}  // namespace axisgate::drive
