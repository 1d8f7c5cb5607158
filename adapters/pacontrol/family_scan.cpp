// Scan of the PA-CONTROL: the port is point to point, so there is one question: does a control answer here?
// In: nothing that matters. Out: the one address, unless a drive has it already. Never asks twice.
#include "adapters/pacontrol/family.hpp"

namespace axisgate::pacontrol {

ScanPlan scan(const ScanWish& wish) {
    ScanPlan plan;
    if (wish.known.empty()) plan.addresses.emplace_back("com1");
    return plan;
}

}  // namespace axisgate::pacontrol
