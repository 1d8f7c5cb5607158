// Family uim342: the table of its makers.
// In: nothing. Out: functions, and what lines of the family are like unless the site says otherwise.
// Never decides anything: that is for the files beside it.
#include "adapters/uim342/family.hpp"

#include "adapters/uim342/adapter.hpp"
#include "adapters/uim342/decoder.hpp"
#include "adapters/uim342/twin/twin.hpp"

namespace axisgate {

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
        uim342::scan,
        nullptr,
        // All of the extended ones: nodes that the site does not name are heard as well, and told of.
        [](std::span<const std::string>) {
            return std::vector<CanIdentifiers>{{true, 0, 0}};
        },
    };
    return family;
}

}  // namespace axisgate
