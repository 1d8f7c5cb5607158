// The example is a template for other families: it is built and tested in all suites, and not shipped.
#include "adapters/example/adapter.hpp"
#include "adapters/example/decoder.hpp"
#include "adapters/example/native.hpp"
#include "adapters/example/twin/twin.hpp"
#include "gateway/drive/scan_range.hpp"

namespace axisgate {

const Family& family_example() {
    static const Family family{
        "example",
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Adapter> { return std::make_unique<example::LineAdapter>(c); },
        [](const Catalogue&, const TwinSetup& setup) -> std::unique_ptr<Twin> { return example::twin::make_twin(setup); },
        [](const Catalogue&, LineKind) -> std::unique_ptr<Decoder> { return std::make_unique<example::LineDecoder>(); },
        example::check_address,
        "1",
        57600,
        "8N1",
        false,
        true,
        0,
        [](const ScanWish& wish) { return drive::scan_range(wish, 1, 99, example::check_address); },
        nullptr,
        nullptr,
        false,
        false,
        nullptr,
        example::stated,
    };
    return family;
}

}  // namespace axisgate
