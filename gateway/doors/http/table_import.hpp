// Table import: a list of the site as CSV, out and in: the whole list, or added to what is there, all rows or none; tried first by
// `dry_run`. In: a call with a table, how its rows are read and checked. Out: what changes, or every faulty line. What the list is of is
// its handlers' to say.
#pragma once

#include <boost/json/array.hpp>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/csv.hpp"
#include "gateway/doors/http/site_change.hpp"

namespace axisgate::http {

/// How the entry with this index is called: "row 3"; nothing if it is none of the table's.
using CalledRow = std::function<std::string(std::size_t index)>;

struct TableImport {
    std::string_view member;  ///< of the site's document, and of the answer: "mappings"
    std::string_view key;     ///< an added row with the key of an entry takes its place
    std::optional<boost::json::array> (*read)(std::string_view csv, std::vector<std::size_t>& lines, std::vector<CsvFault>& faults);
    /// Faults of the list against itself and the rest of the site, pointers below "/<member>/".
    void (*say)(const boost::json::array& list, const Site& before, const Families& families, std::vector<SiteFault>& faults,
                const CalledRow& called);
};

/// `whole`: in place of all entries. `table` outlives the call's job.
[[nodiscard]] Handled import_table(Call& call, SitePort& sites, const StagePort& staging, const TableImport& table, bool whole);
/// The list as a file.
[[nodiscard]] Response table_answer(const SiteState& now, const TableImport& table, std::string csv);

}  // namespace axisgate::http
