// MACS controllers of zub are nodes on CANopen: the family uses the adapter of CiA 402 drives with another dialect, and has its own twin.
#include "adapters/aposs/family.hpp"

#include "adapters/aposs/twin/twin.hpp"
#include "adapters/cia402/adapter.hpp"
#include "adapters/cia402/decoder.hpp"
#include "adapters/cia402/family.hpp"

namespace axisgate {
const Family& family_aposs() {
    static const Family family{
        "aposs",
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Adapter> { return std::make_unique<cia402_drive::LineAdapter>(c); },
        [](const Catalogue& c, const TwinSetup& setup) -> std::unique_ptr<Twin> { return aposs::make_twin(c, setup); },
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Decoder> { return std::make_unique<cia402_drive::CanDecoder>(c); },
        cia402_drive::check_address,
        "1",
        0,
        "",
        true,
        false,
        1'000'000,
        cia402_drive::scan_nodes,
        nullptr,
        cia402_drive::identifiers,
        false,
        false,
        family_cia402,
        cia402_drive::stated,
    };
    return family;
}

}  // namespace axisgate
