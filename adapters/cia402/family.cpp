#include "adapters/cia402/family.hpp"

#include "adapters/cia402/adapter.hpp"
#include "adapters/cia402/decoder.hpp"
#include "adapters/cia402/parameters.hpp"
#include "adapters/cia402/twin/twin.hpp"
#include "gateway/drive/scan_range.hpp"

namespace axisgate {
namespace cia402_drive {

ScanPlan scan_nodes(const ScanWish& wish) {
    ScanPlan plan = drive::scan_range(wish, 1, 127, check_address);
    plan.at_once = 16;
    return plan;
}
std::vector<CanIdentifiers> identifiers(std::span<const std::string> addresses) {
    std::vector<CanIdentifiers> list;
    for (const std::string& a : addresses)
        if (const int n = node_of(a); n != 0) list.push_back({false, 0x7F, static_cast<std::uint32_t>(n)});
    return list;
}

}  // namespace cia402_drive

const Family& family_cia402() {
    static const Family family{
        "cia402",
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Adapter> { return std::make_unique<cia402_drive::LineAdapter>(c); },
        [](const Catalogue& c, const TwinSetup& setup) -> std::unique_ptr<Twin> {
            const auto described = cia402_drive::description_of(c);
            return cia402_drive::twin::make_twin(setup, described ? &*described : nullptr, c.freedoms());
        },
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Decoder> { return std::make_unique<cia402_drive::CanDecoder>(c); },
        cia402_drive::check_address,
        "1",
        0,
        "",
        true,
        false,
        1'000'000,
        cia402_drive::scan_nodes,
        cia402_drive::own_catalogue,
        cia402_drive::identifiers,
        true,
        false,
        nullptr,
        cia402_drive::stated,
    };
    return family;
}

}  // namespace axisgate
