// Site table: a list of the site as CSV, in: the whole list, or added to what is there, all rows or none. In: a table, how its rows are
// read and checked. Out: the site that it would make, with what changes; or every faulty line. What the list is of is its owner's to say.
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

/// How the entry with this index is called: "row 3"; nothing if it is none of the table's.
using CalledRow = std::function<std::string(std::size_t index)>;

struct SiteTable {
    std::string_view member;  ///< of the site's document, and of the answer: "mappings"
    std::string_view key;     ///< an added row with the key of an entry takes its place
    std::optional<boost::json::array> (*read)(std::string_view csv, std::vector<std::size_t>& lines, std::vector<CsvFault>& faults);
    /// Faults of the list against itself and the rest of the site, pointers below "/<member>/".
    void (*say)(const boost::json::array& list, const Site& before, const Families& families, std::vector<SiteFault>& faults,
                const CalledRow& called);
};
extern const SiteTable mapping_table, assembly_table;

/// What could be read of a table; cells that could not be are told with what the rest is wrong in.
struct SiteRows {
    boost::json::array rows;
    std::vector<std::size_t> lines;
    std::vector<CsvFault> faults;
};
[[nodiscard]] Refusable<SiteRows> read_rows(const SiteTable& table, std::string_view csv);
/// `whole`: in place of all entries.
[[nodiscard]] Refusable<Site> site_with_rows(const SiteTable& table, const SiteRows& rows, const Site& before, const Families& families,
                                             bool whole);
[[nodiscard]] boost::json::object import_report(const SiteTable& table, bool dry_run, std::size_t rows, const Site& before,
                                                const Site& after);

}  // namespace axisgate
