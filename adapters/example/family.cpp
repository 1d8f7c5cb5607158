// Family example: the table of its makers, and its scan. A template for others: built and tested with all suites, not shipped.
// In: a catalogue, a line, an address. Out: adapter, twin, decoder. Never decides anything about a drive.
#include "adapters/example/adapter.hpp"
#include "adapters/example/decoder.hpp"
#include "adapters/example/twin/twin.hpp"

namespace axisgate {
namespace {
ScanPlan scan(const ScanWish& wish) {
    ScanPlan plan;
    for (const std::string* end : {&wish.from, &wish.to})
        if (!end->empty() && plan.fault.empty()) plan.fault = example::check_address(*end);
    for (int n = 1; n <= 99 && plan.fault.empty(); ++n)
        if (n >= std::atoi(wish.from.c_str()) && (wish.to.empty() || n <= std::atoi(wish.to.c_str())))
            plan.addresses.push_back(std::to_string(n));
    return plan;
}
}  // namespace

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
        scan,
    };
    return family;
}

}  // namespace axisgate
