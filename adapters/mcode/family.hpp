// Family mcode: what this folder gives to the rest of the gateway.
// In: nothing. Out: the makers of its adapter, twin and decoder, and its timing.
// Never holds data about parameters: that is schema/families/mcode.json.
#pragma once

#include "gateway/core/family.hpp"

namespace axisgate::mcode {
/// Addresses that are worth asking (scan.cpp).
[[nodiscard]] ScanPlan scan(const ScanWish& wish);
}  // namespace axisgate::mcode

namespace axisgate {

/// Lexium MDrive and Lexium Motion Module (MCode) on RS-422, RS-485, UART or Ethernet (port 503).
[[nodiscard]] const Family& family_mcode();

}  // namespace axisgate
