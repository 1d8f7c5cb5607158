// Fuzz: the memory file of `axisgate twin --state`, and each family's twin powered on with what it says.
// In: JSON text. Out: nothing; laws: what is read and written reads back the same; a twin starts with any memory, and keeps what it kept.
#include "gateway/runtime/memory_file.hpp"

#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::map<std::string, NonVolatile> memories;
    const std::string fault = memories_from_json(std::string_view(reinterpret_cast<const char*>(data), size), memories);
    if (!fault.empty()) return 0;
    std::map<std::string, NonVolatile> again;
    fuzz::require(memories_from_json(memories_to_json(memories), again).empty(), "what was written can be read");
    fuzz::require(again == memories, "what was written reads back the same");
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
