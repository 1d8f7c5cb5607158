#include "gateway/runtime/command_tables.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/runtime/catalogues.hpp"
#include "gateway/runtime/commands.hpp"

namespace axisgate {
namespace {
std::string csv_field(const std::string& s) {
    if (s.find_first_of(",\"\r\n") == std::string::npos) return s;
    std::string out = "\"";
    for (const char c : s)
        out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}
}  // namespace

void print_table(const TableRow& head, const std::vector<TableRow>& rows) {
    std::vector<std::size_t> width(head.size());
    const auto measure = [&](const TableRow& r) {
        for (std::size_t i = 0; i < r.size(); ++i)
            width[i] = std::max(width[i], r[i].size());
    };
    measure(head);
    for (const auto& r : rows)
        measure(r);
    const auto print = [&](const TableRow& r) {
        std::string line;
        for (std::size_t i = 0; i < r.size(); ++i)
            line += i + 1 < r.size() ? fmt::format("{:<{}}  ", r[i], width[i]) : r[i];
        fmt::print("{}\n", line);
    };
    print(head);
    for (const auto& r : rows)
        print(r);
}

void print_csv(const TableRow& head, const std::vector<TableRow>& rows) {
    const auto print = [](const TableRow& r) {
        std::string line;
        for (const auto& f : r)
            line += (line.empty() && &f == &r.front() ? "" : ",") + csv_field(f);
        fmt::print("{}\r\n", line);  // RFC 4180
    };
    print(head);
    for (const auto& r : rows)
        print(r);
}

std::optional<FamilyEntry> family_or_complain(const Families& families, const std::string& name) {
    const auto e = families.find(name);
    if (e.family) return e;
    complain(fmt::format("there is no family {}; families: {}", name, families.names()));
    return std::nullopt;
}

std::optional<Families> families_or_complain() {
    std::vector<std::string> faults;
    auto families = load_families(faults);
    for (const auto& f : faults)
        complain(f);
    if (!faults.empty()) return std::nullopt;
    return families;
}

}  // namespace axisgate
