// Family linmot: the table of its makers, its addresses and the search for drives.
// In: addresses as text. Out: makers, faults, the list of IDs to ask.
// Never decides anything about a drive.
#include "adapters/linmot/family.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "adapters/linmot/adapter.hpp"
#include "adapters/linmot/decoder.hpp"
#include "adapters/linmot/twin/twin.hpp"
#include "gateway/drive/scan_range.hpp"

namespace axisgate {
namespace linmot {

std::string check_address(std::string_view address) {
    unsigned id = 0;
    const auto [end, ec] = std::from_chars(address.data(), address.data() + address.size(), id);
    const bool plain = address.size() == 1 || (!address.empty() && address[0] != '0');
    if (ec == std::errc{} && end == address.data() + address.size() && id <= 255 && plain) return {};
    const bool printable = std::ranges::all_of(address, [](char c) { return c >= 0x20 && c < 0x7F; });
    return fmt::format("{} is not the ID of a LinMot drive: write a number 0..255, as its switches or parameters have it",
                       address.empty() ? "nothing"
                       : printable     ? address
                                       : "this");
}

ScanPlan scan(const ScanWish& wish) { return drive::scan_range(wish, 0, 255, check_address); }

}  // namespace linmot

const Family& family_linmot() {
    static const Family family{
        "linmot",
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Adapter> { return std::make_unique<linmot::LineAdapter>(c); },
        [](const Catalogue& c, const TwinSetup& setup) -> std::unique_ptr<Twin> { return linmot::twin::make_twin(c, setup); },
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Decoder> { return std::make_unique<linmot::LineDecoder>(c); },
        linmot::check_address,
        "17",   // 11h, the ID of every printed telegram
        38400,  // no factory rate is known: the switch S1 decides; a choice
        "8N1",
        false,
        true,
        0,
        linmot::scan,
    };
    return family;
}

}  // namespace axisgate
