// An axis of another gateway is a drive of this family; the DDS fleet connects the two gateways.
#include "adapters/remote/adapter.hpp"
#include "adapters/remote/decoder.hpp"
#include "adapters/remote/twin/twin.hpp"

namespace axisgate {

const Family& family_remote() {
    static const Family family{
        "remote",
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Adapter> { return std::make_unique<remote::LineAdapter>(c); },
        [](const Catalogue&, const TwinSetup& setup) -> std::unique_ptr<Twin> { return remote::twin::make_twin(setup); },
        [](const Catalogue&, LineKind) -> std::unique_ptr<Decoder> { return std::make_unique<remote::LineDecoder>(); },
        mirror::check_address,
        "hall-2/axis-1",
        0,  // the line is inside this process: no bit rate
        "",
        false,
        true,
        0,
        nullptr,
        nullptr,
        nullptr,
        false,
        true,  // on a line dds
        nullptr,
        // Native statements and parameter writes are refused, and the only action is a query.
        [](const Catalogue&, int, const CommandBody&) { return Stated{Stated::Kind::nothing}; },
    };
    return family;
}

}  // namespace axisgate
