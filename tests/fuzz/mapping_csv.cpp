// Fuzz target for user maps and assemblies as CSV, and as JSON entries against a site with one axis of every family. Laws: rows or faults
// with their lines; accepted rows can be written and are read as the same; values survive the registers of their mapping.
#include <boost/json.hpp>

#include "gateway/site/assembly.hpp"
#include "gateway/site/mapping.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using fuzz::require;
namespace json = boost::json;

namespace {
const Site& site() {
    static const Site one = [] {
        json::array lines, drives, axes;
        for (const auto& e : fuzz::families().entries) {
            const std::string name(e.family->name);
            lines.push_back({{"name", name}, {"uri", "twin"}, {"family", name}});
            drives.push_back({{"name", name}, {"line", name}, {"address", e.family->factory_address}});
            axes.push_back({{"name", "axis" + std::to_string(axes.size() + 1)}, {"drive", name}, {"number", axes.size() + 1}});
        }
        std::vector<SiteFault> faults;
        auto s = parse_site(json::value{{"lines", lines}, {"drives", drives}, {"axes", axes}}, fuzz::families(), faults);
        require(s.has_value(), "the site of the target is good");
        return std::move(*s);
    }();
    return one;
}

std::optional<std::vector<Mapping>> read(std::string_view csv, bool& readable) {
    std::vector<std::size_t> lines;
    std::vector<CsvFault> faults;
    const auto rows = mappings_from_csv(csv, lines, faults);
    require(rows || !faults.empty(), "rows, or why not");
    const auto file_lines = static_cast<std::size_t>(std::ranges::count(csv, '\n')) + 1;
    for (const auto& f : faults)
        require(f.line <= file_lines && !f.text.empty(), "a fault has its line and words");
    readable = rows && faults.empty();
    if (!readable) return std::nullopt;
    require(lines.size() == rows->size(), "every row has its line");
    std::vector<SiteFault> wrong;
    auto list = parse_mappings(*rows, site(), fuzz::families(), wrong);
    require(list.has_value() == wrong.empty(), "mappings or faults, never both and never neither");
    return list;
}

/// The same text as a table of assemblies: rows or faults; accepted rows can be written and are read as the same.
std::optional<std::vector<AssemblySpec>> read_assembly_table(std::string_view csv) {
    std::vector<std::size_t> lines;
    std::vector<CsvFault> faults;
    const auto rows = assemblies_from_csv(csv, lines, faults);
    require(rows || !faults.empty(), "rows, or why not");
    if (!rows || !faults.empty()) return std::nullopt;
    require(lines.size() == rows->size() && rows->size() <= most_assemblies, "every row has its line");
    Site with = site();
    std::vector<SiteFault> wrong;
    const json::value entries(*rows);
    read_assemblies(&entries, with, wrong);
    const bool readable = wrong.empty();
    check_assemblies(with, wrong, [&](std::size_t i) { return "row " + std::to_string(lines[i]); });
    for (const auto& f : wrong)
        require(f.pointer.starts_with("/assemblies") && !f.text.empty(), "a fault has its place and words");
    if (!readable) return std::nullopt;  // an assembly without mappings is not served, but can be read
    return with.assemblies;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 32 * 1024) return 0;
    if (const auto assemblies = read_assembly_table({reinterpret_cast<const char*>(data), size})) {
        const auto again = read_assembly_table(assemblies_to_csv(*assemblies));
        require(again && *again == *assemblies, "assemblies that were written can be read and are the same");
    }
    bool readable = false;
    const auto list = read({reinterpret_cast<const char*>(data), size}, readable);
    if (!list) return 0;
    const std::string out = mappings_to_csv(*list);
    const auto again = read(out, readable);
    require(again.has_value(), "what was written can be read");
    require(mappings_to_csv(*again) == out, "and is the same");
    for (const Mapping& m : *list) {
        require(m.end() <= 65536, "a mapping ends within its table");
        std::vector<std::uint8_t> words(std::size_t{2} * m.size());
        for (std::size_t i = 0; i < words.size() && i < size; ++i)
            words[i] = data[i];
        const Value v = decode(m, words.data());
        std::vector<std::uint8_t> back(words.size());
        if (known(v) && encode(m, v, back.data())) (void)decode(m, back.data());
    }
    return 0;
}
