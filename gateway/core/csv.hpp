// Reads tables of spreadsheets with any separator (otherwise RFC 4180: doubled quotes, CR LF or LF, a byte order mark). The text may have
// any origin. A cell that cannot be read is a fault of its line. `csv_cell` of text.hpp writes cells.
#pragma once

#include <boost/json/array.hpp>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

struct CsvFault {
    std::size_t line = 0;  ///< 1-based; 0: not a line of the table, but a consequence for the rest
    std::string text;
};

struct CsvLine {
    std::size_t number = 0;  ///< of its first line in the text, 1-based
    std::vector<std::string> cells;
};

/// Splits a text into lines and cells. The first line determines the separator: a tab if there is one, otherwise a semicolon if it has more
/// of these than commas.
class CsvReader {
public:
    static constexpr std::size_t longest_line = 4096;  ///< bytes; for quoted cells including line breaks

    /// `text` must outlive it.
    explicit CsvReader(std::string_view text);
    /// The next line that has more than empty cells, with cells as they were given to csv_cell; empty at the end, or if `fault` has a
    /// reason.
    [[nodiscard]] std::optional<CsvLine> next();
    [[nodiscard]] const std::optional<CsvFault>& fault() const noexcept { return fault_; }
    [[nodiscard]] char separator() const noexcept { return separator_; }

private:
    std::string_view rest_;
    char separator_ = ',';
    std::size_t line_ = 1;
    std::optional<CsvFault> fault_;
};

struct CsvColumn {
    std::string_view name;
    bool number = false;  ///< with a comma in it if cells are not separated by commas
};
/// A table of one kind of entries, with the words for messages about its columns.
struct CsvShape {
    std::span<const CsvColumn> columns;
    std::size_t most = 0;    ///< rows
    std::string_view what;   ///< "mappings"
    std::string_view needs;  ///< the columns with which a first line begins: "id,unit,table,..."
};
/// The columns' names, with a line end.
[[nodiscard]] std::string csv_head(const CsvShape& shape);
/// The rows that can be read, with members by their columns (without empty cells), the line of each in `lines`, and the faults of the other
/// rows. The rows may be used only if there are no faults; otherwise they help to find further faults. Empty if the columns cannot be read.
/// `faults` and `lines` must be empty.
[[nodiscard]] std::optional<boost::json::array> rows_from_csv(std::string_view csv, const CsvShape& shape, std::vector<std::size_t>& lines,
                                                              std::vector<CsvFault>& faults);

}  // namespace axisgate
