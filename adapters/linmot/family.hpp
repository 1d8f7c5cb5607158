// Family linmot: what this folder gives to the rest of the gateway.
// In: nothing. Out: the makers of its adapter, twin and decoder, and its timing.
// Never holds data about parameters: that is schema/families/linmot.json.
#pragma once

#include "gateway/core/family.hpp"

namespace axisgate::linmot {
/// Empty if `address` is an ID 0..255, else what is wrong and what would be right.
[[nodiscard]] std::string check_address(std::string_view address);
/// Addresses that are worth asking.
[[nodiscard]] ScanPlan scan(const ScanWish& wish);
}  // namespace axisgate::linmot

namespace axisgate {

/// LinMot E1100 and B1100 on RS-232, RS-422 or RS-485 (LinRS).
[[nodiscard]] const Family& family_linmot();

}  // namespace axisgate
