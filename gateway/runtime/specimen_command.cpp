// Tells which choices a family's page lists, and which of them one specimen of its simulated drive has made. The page is the program's own,
// so nothing is asked.
#include <fmt/core.h>

#include <boost/json/serialize.hpp>

#include "gateway/core/specimen.hpp"
#include "gateway/runtime/command_tables.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/services/specimens.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {

std::string range_of(const Freedom& f) {
    if (f.values.empty()) return fmt::format("{} to {}{}{}", f.min, f.max, f.unit.empty() ? "" : " ", f.unit);
    std::string list;
    for (const auto& [n, meaning] : f.values)
        list += fmt::format("{}{} = {}", list.empty() ? "" : ", ", n, meaning);
    return list;
}

std::string extremes_of(const Freedom& f) {
    std::string list;
    for (const auto& [name, value] : f.extremes)
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", name, value);
    return list;
}

int print_freedoms(const Catalogue& page, bool as_json) {
    if (as_json) {
        json::array names;
        for (const auto name : named_specimens)
            names.emplace_back(name);
        const json::object out{{"family", page.family()}, {"named_specimens", std::move(names)}, {"freedoms", freedoms_document(page)}};
        fmt::print("{}\n", json::serialize(out));
        return exit_good;
    }
    std::vector<TableRow> rows;
    for (const Freedom& f : page.freedoms())
        rows.push_back({f.name, range_of(f), std::to_string(f.fallback), extremes_of(f), f.source, f.description});
    print_table({"freedom", "range", "default", "named", "source", "description"}, rows);
    return exit_good;
}
}  // namespace

int command_specimen(const std::string& family, const std::string& specimen, bool as_json) {
    const auto families = families_or_complain();
    if (!families) return exit_failed;
    const auto entry = family_or_complain(*families, family);
    if (!entry) return exit_usage;
    const Catalogue& page = *entry->catalogue;
    if (specimen.empty()) return print_freedoms(page, as_json);
    if (const std::string wrong = check_specimen(specimen); !wrong.empty()) {
        complain(wrong);
        return exit_usage;
    }
    if (as_json) {
        fmt::print("{}\n", json::serialize(specimen_document(page, specimen)));
        return exit_good;
    }
    const auto words = specimen_in_words(page, specimen_values(page, specimen));
    if (words.empty())
        fmt::print("{} specimen {}: the drive as its manual shows it\n", family, specimen);
    else
        fmt::print("{} specimen {} differs from the drive that its manual shows in {} of {} freedoms:\n", family, specimen, words.size(),
                   page.freedoms().size());
    for (const auto& line : words)
        fmt::print("  {}\n", line);
    return exit_good;
}

}  // namespace axisgate
