#include "adapters/linmot/adapter.hpp"
#include "adapters/linmot/decoder.hpp"
#include "adapters/linmot/native.hpp"
#include "adapters/linmot/twin/twin.hpp"
#include "gateway/drive/scan_range.hpp"

namespace axisgate {

/// LinMot E1100 and B1100 on RS-232, RS-422 or RS-485 (LinRS).
const Family& family_linmot() {
    static const Family family{
        "linmot",
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Adapter> { return std::make_unique<linmot::LineAdapter>(c); },
        [](const Catalogue& c, const TwinSetup& setup) -> std::unique_ptr<Twin> { return linmot::twin::make_twin(c, setup); },
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Decoder> { return std::make_unique<linmot::LineDecoder>(c); },
        linmot::check_address,
        "17",   // 11h, the ID in every telegram of the manual
        38400,  // no factory bit rate is known (switch S1 selects it); a choice
        "8N1",
        false,
        true,
        0,
        [](const ScanWish& wish) { return drive::scan_range(wish, 0, 255, linmot::check_address); },
        nullptr,
        nullptr,
        false,
        false,
        nullptr,
        linmot::stated,
    };
    return family;
}

}  // namespace axisgate
