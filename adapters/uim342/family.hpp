// Family uim342: what this folder gives to the rest of the gateway.
// In: nothing. Out: the makers of its adapter, twin and decoder, and its timing.
// Never holds data about parameters: that is schema/families/uim342.json.
#pragma once

#include "gateway/core/family.hpp"

namespace axisgate::uim342 {
/// Addresses that are worth asking (scan.cpp).
[[nodiscard]] ScanPlan scan(const ScanWish& wish);
}  // namespace axisgate::uim342

namespace axisgate {

/// UIROBOT UIM342 on CAN (SimpleCAN 3.0) or behind a UIM2513 / 2523 / 2533 gateway (UIMessage).
[[nodiscard]] const Family& family_uim342();

}  // namespace axisgate
