// Family pacontrol: the table of its makers.
// In: nothing. Out: functions, and what lines of the family are like unless the site says otherwise.
// Never decides anything: that is for the files beside it.
#include "adapters/pacontrol/adapter.hpp"
#include "adapters/pacontrol/decoder.hpp"
#include "adapters/pacontrol/native.hpp"
#include "adapters/pacontrol/twin/twin.hpp"

namespace axisgate {

/// IEF Werner PA-CONTROL on its serial command port COM1.
const Family& family_pacontrol() {
    static const Family family{
        "pacontrol",
        [](const Catalogue& c, LineKind kind) -> std::unique_ptr<Adapter> { return std::make_unique<pacontrol::LineAdapter>(c, kind); },
        [](const Catalogue& c, const TwinSetup& setup) -> std::unique_ptr<Twin> { return pacontrol::twin::make_twin(c, setup); },
        [](const Catalogue&, LineKind) -> std::unique_ptr<Decoder> { return std::make_unique<pacontrol::LineDecoder>(); },
        pacontrol::check_address,
        "com1",  // the port is point to point and has no address
        9600,    // [L1041]
        "7N1",
        false,
        true,
        0,
        // The port is point to point, so there is one question: does a control answer here? None where a drive has the address already.
        [](const ScanWish& wish) {
            ScanPlan plan;
            if (wish.known.empty()) plan.addresses.emplace_back("com1");
            return plan;
        },
        nullptr,
        nullptr,
        false,
        false,
        nullptr,
        pacontrol::stated,
    };
    return family;
}

}  // namespace axisgate
