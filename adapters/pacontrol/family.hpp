// Family pacontrol: what this folder gives to the rest of the gateway.
// In: nothing. Out: the makers of its adapter, twin and decoder, and its scan.
// Never holds data about parameters: that is schema/families/pacontrol.json.
#pragma once

#include "gateway/core/family.hpp"

namespace axisgate::pacontrol {
/// Addresses that are worth asking.
[[nodiscard]] ScanPlan scan(const ScanWish& wish);
}  // namespace axisgate::pacontrol

namespace axisgate {

/// IEF Werner PA-CONTROL on its serial command port COM1.
[[nodiscard]] const Family& family_pacontrol();

}  // namespace axisgate
