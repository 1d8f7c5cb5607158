// CSV: tables of a spreadsheet read back, whatever it separates cells by (RFC 4180 beside it: quotes doubled, CR LF or LF, a byte order
// mark). In: text of strangers. Out: lines of cells with their numbers, rows as JSON objects, and every faulty line. `csv_cell` of text.hpp
// writes. Never guesses a value: a cell that cannot be read is a fault of its line.
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
    std::size_t line = 0;  ///< 1-based; 0: no line of the table, but what it would make of the rest
    std::string text;
};

struct CsvLine {
    std::size_t number = 0;  ///< of its first line in the text, 1-based
    std::vector<std::string> cells;
};

/// Takes a text apart. The separator is what the first line has: a tab if there is one, else a semicolon if it has more of these than
/// commas.
class CsvReader {
public:
    static constexpr std::size_t longest_line = 4096;  ///< bytes, those of a quoted cell with line breaks together

    /// `text` outlives it.
    explicit CsvReader(std::string_view text);
    /// The next line that has more than empty cells, cells as they were given to csv_cell; nothing at the end, or where `fault` says why
    /// not.
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
    bool number = false;  ///< with a comma in it where cells are not separated by commas
};
/// A table of one thing after another, and what is written where its columns are told.
struct CsvShape {
    std::span<const CsvColumn> columns;
    std::size_t most = 0;    ///< rows
    std::string_view what;   ///< "mappings"
    std::string_view needs;  ///< the columns that a first line begins with: "id,unit,table,..."
};
/// The columns' names, with a line end.
[[nodiscard]] std::string csv_head(const CsvShape& shape);
/// The rows that can be read, members by their columns without those of empty cells, with the line of each in `lines`, and the faults of
/// those that cannot: only without any may the rows be used; with some they still tell what else is wrong. Nothing if the columns cannot be
/// read. `faults` and `lines` come empty.
[[nodiscard]] std::optional<boost::json::array> rows_from_csv(std::string_view csv, const CsvShape& shape, std::vector<std::size_t>& lines,
                                                              std::vector<CsvFault>& faults);

}  // namespace axisgate
