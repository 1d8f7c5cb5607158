// Fuzz target for the memory file of `axisgate twin --state`, and each family's twin started with it. Laws: an accepted file can be written
// and is read as the same; a twin starts with any memory and keeps it.
#include "gateway/services/parameters/memory_file.hpp"

#include <algorithm>
#include <cmath>

#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;

namespace {
/// Equal except for the last digit of a floating-point number, because Boost.JSON does not read these to the nearest value.
bool same(const std::map<std::string, NonVolatile>& a, const std::map<std::string, NonVolatile>& b) {
    const auto alike = [](const auto& x, const auto& y) {
        const auto *d = std::get_if<double>(&x.second), *e = std::get_if<double>(&y.second);
        if (!d || !e) return x == y;
        return x.first == y.first && (*d == *e || std::fabs(*d - *e) <= 1e-14 * std::fabs(*d));
    };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const auto& x, const auto& y) {
        return x.first == y.first && std::equal(x.second.begin(), x.second.end(), y.second.begin(), y.second.end(), alike);
    });
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::map<std::string, NonVolatile> memories;
    const std::string fault = memories_from_json(std::string_view(reinterpret_cast<const char*>(data), size), memories);
    if (!fault.empty()) return 0;
    std::map<std::string, NonVolatile> again;
    fuzz::require(memories_from_json(memories_to_json(memories), again).empty(), "what was written can be read");
    fuzz::require(same(again, memories), "what was written reads back the same");
    for (const auto& e : fuzz::families().entries) {
        for (const auto& [address, memory] : memories) {
            TwinSetup setup;
            setup.address = address;
            setup.kind = e.family->uses_can ? LineKind::can : LineKind::bytes;
            const auto twin = e.family->make_twin(*e.catalogue, setup);
            Out out;
            twin->power_on(memory, at_ns(1), out);
            const NonVolatile kept = twin->non_volatile();
            const auto second = e.family->make_twin(*e.catalogue, setup);
            out.clear();
            second->power_on(kept, at_ns(1), out);
            fuzz::require(second->non_volatile() == kept, "a memory is kept over power-off as it is");
        }
    }
    return 0;
}
