// Scan range: the addresses of a scan where drives are numbered.
// In: what somebody wishes, the numbers that there can be, the family's check. Out: the plan, or what is wrong with the wish.
// Never asks anybody, and never more than `last - first + 1` addresses.
#pragma once

#include <string>
#include <string_view>

#include "gateway/core/family.hpp"

namespace axisgate::drive {

/// Every number from `wish.from` (else `first`) to `wish.to` (else `last`), in order. `check`: empty, or why a text is no address.
[[nodiscard]] ScanPlan scan_range(const ScanWish& wish, int first, int last, std::string (*check)(std::string_view));

}  // namespace axisgate::drive
