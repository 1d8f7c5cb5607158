// Imports a list of the site as CSV: instead of the whole list, or added to it, all rows or none. The owner of the list describes how its
// rows are read and checked. The result is the changed site, or every faulty line.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/csv.hpp"
#include "gateway/services/refusal.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

/// The name of the entry with this index: "row 3"; empty if it does not come from the table.
using CalledRow = std::function<std::string(std::size_t index)>;

struct SiteTable {
    std::string_view member;  ///< of the site's document, and of the answer: "mappings"
    std::string_view key;     ///< an added row with the key of an entry replaces it
    std::optional<boost::json::array> (*read)(std::string_view csv, std::vector<std::size_t>& lines, std::vector<CsvFault>& faults);
    /// Reports faults of the list against itself and the rest of the site, with pointers below "/<member>/".
    void (*say)(const boost::json::array& list, const Site& before, const Families& families, std::vector<SiteFault>& faults,
                const CalledRow& called);
};
extern const SiteTable mapping_table, assembly_table;

/// The readable part of a table; unreadable cells are reported together with the other faults.
struct SiteRows {
    boost::json::array rows;
    std::vector<std::size_t> lines;
    std::vector<CsvFault> faults;
};
[[nodiscard]] Refusable<SiteRows> read_rows(const SiteTable& table, std::string_view csv);
/// `whole`: instead of all entries.
[[nodiscard]] Refusable<Site> site_with_rows(const SiteTable& table, const SiteRows& rows, const Site& before, const Families& families,
                                             bool whole);
[[nodiscard]] boost::json::object import_report(const SiteTable& table, bool dry_run, std::size_t rows, const Site& before,
                                                const Site& after);

}  // namespace axisgate
