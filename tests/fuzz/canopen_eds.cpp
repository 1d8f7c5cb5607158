// Fuzz target for EDS and DCF files. Laws: a description or faults, each with its line and text; an accepted file can be written as a DCF,
// which is read as the same; its dictionary has bytes of the length of every type.
#include "gateway/protocols/canopen/eds.hpp"

#include <algorithm>

#include "gateway/core/text.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using namespace axisgate::canopen;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    std::vector<FileFault> faults, notes;
    const auto eds = read_eds(text, faults, notes);
    require(eds.has_value() == faults.empty(), "a description, or faults");
    require(faults.size() <= most_file_faults + 1 && notes.size() <= most_file_faults + 1, "a bounded number of them");
    const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n') + std::ranges::count(text, '\r')) + 1;
    for (const auto& list : {faults, notes})
        for (const auto& f : list)
            require(f.line <= lines && !f.text.empty() && is_utf8(f.text), "a fault has its line and words");
    if (!eds) return 0;
    require(!eds->objects.empty() && eds->entries.size() <= Eds::most_entries, "it has objects, and not too many");

    std::map<Address, Value> values;
    for (const auto& [address, e] : eds->entries) {
        if (e.fallback.given() && !e.fallback.plus_node) values[address] = e.fallback.value;
    }
    std::vector<std::string> left_out;
    const Commissioning c = eds->commissioning.value_or(Commissioning{1, "", 0});
    const std::string dcf = write_dcf(*eds, c, values, {}, left_out);
    std::vector<FileFault> wrong;
    notes.clear();
    const auto again = read_eds(dcf, wrong, notes);
    for (const auto& f : wrong)
        std::fprintf(stderr, "%zu: %s\n", f.line, f.text.c_str());
    require(again.has_value(), "what was written can be read");
    Eds expected = *eds;
    expected.commissioning = c;
    for (const auto& [address, value] : values) {
        if (expected.entries.at(address).type != DataType::domain) expected.entries.at(address).configured = {value, false};
    }
    require(*again == expected, "and is the same");

    const Dictionary d = dictionary_of(*eds, c.node);
    for (const auto& [address, e] : d.entries()) {
        const auto bytes = bytes_of(e.type);
        require(!bytes || e.bytes.size() == *bytes, "an entry has its type's length");
    }
    return 0;
}
