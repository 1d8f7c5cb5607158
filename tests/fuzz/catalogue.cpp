// Fuzz target for a family's catalogue page. Laws: a catalogue or faults; every parameter is found by its id, and writes are checked
// without a crash.
#include "gateway/core/catalogue.hpp"

#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::string> faults;
    const auto catalogue = Catalogue::parse(std::string_view(reinterpret_cast<const char*>(data), size), faults);
    fuzz::require(catalogue.has_value() == faults.empty(), "a catalogue, or faults");
    for (const auto& f : faults)
        fuzz::require(!f.empty(), "a fault is a sentence");
    if (!catalogue) return 0;
    const Value values[]{Value{},    Value{true},  Value{std::int64_t{0}}, Value{INT64_MIN},          Value{INT64_MAX},
                         Value{0.5}, Value{1e300}, Value{std::string()},   Value{std::string("text")}};
    for (std::uint16_t i = 0; i < catalogue->parameters().size(); ++i) {
        const Parameter& p = catalogue->parameters()[i];
        const Point point{i, p.count ? p.first : std::uint16_t{0}};
        fuzz::require(catalogue->parameter(point) == &p, "a parameter is found by its place");
        const auto found = catalogue->find(catalogue->id_of(point));
        fuzz::require(found && *found == point, "and by its id");
        for (const auto& v : values) {
            const auto checked = catalogue->check_write(point, v);
            fuzz::require(checked.fault.empty() == known(checked.value), "a write gives a value or a fault");
        }
    }
    for (const auto& e : catalogue->errors()) {
        const auto* found = catalogue->error(e.code, e.kind);
        fuzz::require(found && found->code == e.code, "an error is found by its code");
    }
    return 0;
}
