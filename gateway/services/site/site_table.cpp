// Rows become entries of the site's document, which parse_site checks as a whole. A table with a fault changes nothing.
#include "gateway/services/site/site_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

namespace axisgate {
namespace json = boost::json;
namespace {

ServiceRefusal csv_refusal(const std::vector<CsvFault>& faults) {
    const auto words = [](const CsvFault& f) { return f.line == 0 ? f.text : fmt::format("line {}: {}", f.line, f.text); };
    ServiceRefusal refusal{ServiceRefusal::Why::invalid,
                           words(faults.front()) + (faults.size() > 1 ? fmt::format(" (and {} more)", faults.size() - 1) : std::string())};
    for (const auto& f : faults)
        refusal.faults.push_back({f.line == 0 ? std::string() : fmt::format("/{}", f.line), f.text,
                                  "mend the line: nothing has been taken from the file", true});
    return refusal;
}

const json::value* row_key(const json::value& entry, std::string_view key) {
    const auto* k = entry.get_object().if_contains(key);
    return k && !k->is_null() ? k : nullptr;
}
std::optional<std::size_t> row_place(const json::array& list, const json::value& row, std::string_view key) {
    const auto* wanted = row_key(row, key);
    for (std::size_t i = 0; wanted && i < list.size(); ++i) {
        const auto* k = row_key(list[i], key);
        // All numbers of a table are floating-point ones.
        if (k && (k->is_number() && wanted->is_number() ? k->to_number<double>() == wanted->to_number<double>() : *k == *wanted)) return i;
    }
    return std::nullopt;
}

/// The rows at their indices, with the line of each; 0: an existing entry.
struct MergedRows {
    json::array list;
    std::vector<std::size_t> line_of;
};
MergedRows merged_rows(json::array before, const json::array& rows, const std::vector<std::size_t>& lines, std::string_view key) {
    MergedRows m{std::move(before), {}};
    m.line_of.assign(m.list.size(), 0);
    const std::size_t own = m.list.size();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto known = row_place(m.list, rows[i], key);
        if (known && *known < own && m.line_of[*known] == 0) {
            m.list[*known] = rows[i];
            m.line_of[*known] = lines[i];
        } else {
            m.list.push_back(rows[i]);
            m.line_of.push_back(lines[i]);
        }
    }
    return m;
}

/// All faults by lines: cells that could not be read, conflicts between rows and with the site, and consequences for the rest of the site.
ServiceRefusal table_refusal(const SiteTable& table, const MergedRows& merged, std::vector<CsvFault> wrong,
                             const std::vector<SiteFault>& of_site, const Site& before, const Families& families) {
    const std::string head = fmt::format("/{}/", table.member);
    const auto row = [&](std::size_t i) {
        return i < merged.line_of.size() && merged.line_of[i] != 0 ? fmt::format("row {}", merged.line_of[i]) : std::string();
    };
    std::vector<SiteFault> faults;
    table.say(merged.list, before, families, faults, row);
    // Missing or wrong rows would cause faults elsewhere that are not real.
    if (faults.empty() && wrong.empty()) faults = of_site;
    const bool unread = !wrong.empty();
    for (const auto& f : faults) {
        std::size_t index = merged.line_of.size();
        if (f.pointer.starts_with(head)) std::from_chars(f.pointer.data() + head.size(), f.pointer.data() + f.pointer.size(), index);
        if (unread && index >= merged.line_of.size()) continue;  // of a list that is not the whole table
        wrong.push_back({index < merged.line_of.size() ? merged.line_of[index] : 0, fmt::format("{}; {}", f.text, f.remedy)});
    }
    std::ranges::stable_sort(wrong, {}, &CsvFault::line);
    return csv_refusal(wrong);
}

}  // namespace

Refusable<SiteRows> read_rows(const SiteTable& table, std::string_view csv) {
    SiteRows out;
    auto rows = table.read(csv, out.lines, out.faults);
    if (!rows) return csv_refusal(out.faults);
    out.rows = std::move(*rows);
    return out;
}

Refusable<Site> site_with_rows(const SiteTable& table, const SiteRows& rows, const Site& before, const Families& families, bool whole) {
    json::object document = to_json(before);
    const auto* list = document.if_contains(table.member);
    const MergedRows merged = merged_rows(list && !whole ? list->get_array() : json::array(), rows.rows, rows.lines, table.key);
    document[table.member] = merged.list;
    std::vector<SiteFault> faults;
    auto site = parse_site(document, families, faults);
    if (!site || !rows.faults.empty()) return table_refusal(table, merged, rows.faults, faults, before, families);
    return *std::move(site);
}

json::object import_report(const SiteTable& table, bool dry_run, std::size_t rows, const Site& before, const Site& after) {
    json::array changes;
    for (const auto& x : differences(before, after))
        changes.emplace_back(x);
    const auto document = to_json(after);
    const auto* list = document.if_contains(table.member);
    return {{"dry_run", dry_run}, {"rows", rows}, {table.member, list ? list->get_array().size() : 0}, {"differences", std::move(changes)}};
}

}  // namespace axisgate
