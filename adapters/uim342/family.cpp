// Family uim342: the table of its makers, and its scan.
// In: nothing. Out: functions, and what lines of the family are like unless the site says otherwise.
// Never decides anything: that is for the files beside it.
#include "adapters/uim342/adapter.hpp"
#include "adapters/uim342/decoder.hpp"
#include "adapters/uim342/native.hpp"
#include "adapters/uim342/twin/twin.hpp"
#include "gateway/drive/scan_range.hpp"

namespace axisgate {
namespace {
/// Every node ID is asked for its model (ML); never the global or a group address, where everybody would answer at once.
ScanPlan uim342_scan(const ScanWish& wish) {
    ScanPlan plan = drive::scan_range(wish, uim342::first_node, uim342::last_node, uim342::check_address);
    plan.at_once = wish.kind == LineKind::can ? 8 : 2;
    return plan;
}
}  // namespace

/// UIROBOT UIM342 on CAN (SimpleCAN 3.0) or behind a UIM2513 / 2523 / 2533 gateway (UIMessage).
const Family& family_uim342() {
    static const Family family{
        "uim342",
        [](const Catalogue& c, LineKind kind) -> std::unique_ptr<Adapter> { return std::make_unique<uim342::LineAdapter>(c, kind); },
        [](const Catalogue& c, const TwinSetup& setup) -> std::unique_ptr<Twin> { return uim342::make_twin(c, setup); },
        [](const Catalogue&, LineKind kind) -> std::unique_ptr<Decoder> { return std::make_unique<uim342::LineDecoder>(kind); },
        uim342::check_address,
        "5",    // PP[7] of a new drive [L677]
        57600,  // default of the makers' software for the UIM2513
        "8N1",
        true,
        true,
        500'000,  // what the twin's factory setting says; the manual is silent
        uim342_scan,
        nullptr,
        // All of the extended ones: nodes that the site does not name are heard as well, and told of.
        [](std::span<const std::string>) {
            return std::vector<CanIdentifiers>{{true, 0, 0}};
        },
        false,
        false,
        nullptr,
        uim342::stated,
    };
    return family;
}

}  // namespace axisgate
