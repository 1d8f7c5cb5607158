// Scan of the UIM342: every node ID is asked for its model (ML), as at the start of any drive.
// In: first and last ID. Out: the IDs in order. Never asks the global or a group address: everybody would answer at once.
#include "adapters/uim342/adapter.hpp"
#include "adapters/uim342/family.hpp"
#include "adapters/uim342/wire.hpp"
#include "gateway/drive/scan_range.hpp"

namespace axisgate::uim342 {

ScanPlan scan(const ScanWish& wish) {
    ScanPlan plan = drive::scan_range(wish, first_node, last_node, check_address);
    plan.at_once = wish.kind == LineKind::can ? 8 : 2;
    return plan;
}

}  // namespace axisgate::uim342
