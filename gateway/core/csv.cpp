// One pass over the text, line by line; rows by the names of the first line. At most `most_kept` faults are kept, and nothing is read
// behind a quote that is left open.
#include "gateway/core/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace axisgate {
namespace {
constexpr std::size_t most_kept = 1000;

/// Removes the mark that csv_cell has put before a text that a spreadsheet would evaluate.
void take_mark_away(std::string& cell) {
    const auto first = cell.find_first_not_of('\'');
    if (first != 0 && first != std::string::npos && std::string_view("=+-@").find(cell[first]) != std::string_view::npos) cell.erase(0, 1);
}

std::string names_of(const CsvShape& shape, std::string_view between) {
    std::string out;
    for (const auto& c : shape.columns)
        out += fmt::format("{}{}", out.empty() ? "" : between, c.name);
    return out;
}
}  // namespace

CsvReader::CsvReader(std::string_view text) : rest_(text) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
    const auto begin = std::min(rest_.find_first_not_of("\r\n"), rest_.size());
    const std::string_view first = rest_.substr(begin, rest_.find('\n', begin) - begin);
    if (first.find('\t') != std::string_view::npos) {
        separator_ = '\t';
    } else if (std::ranges::count(first, ';') > std::ranges::count(first, ',')) {
        separator_ = ';';
    }
}

std::optional<CsvLine> CsvReader::next() {
    while (!rest_.empty() && !fault_) {
        CsvLine out{line_, std::vector<std::string>(1)};
        bool inside = false;
        std::size_t i = 0, breaks = 0;
        for (; i < rest_.size(); ++i) {
            const char c = rest_[i];
            if (i > longest_line) break;
            std::string& cell = out.cells.back();
            if (inside) {
                if (c == '"' && i + 1 < rest_.size() && rest_[i + 1] == '"') {
                    cell += '"';
                    ++i;
                } else if (c == '"') {
                    inside = false;
                } else {
                    breaks += c == '\n' ? 1 : 0;
                    cell += c;
                }
            } else if (c == '"' && cell.empty()) {
                inside = true;
            } else if (c == separator_) {
                out.cells.emplace_back();
            } else if (c == '\n') {
                break;
            } else if (c != '\r') {
                cell += c;
            }
        }
        if (inside || i > longest_line) {
            fault_ = CsvFault{line_, fmt::format("a quote is not closed, or the line is longer than {} characters", longest_line)};
            return std::nullopt;
        }
        rest_.remove_prefix(std::min(i + 1, rest_.size()));
        line_ += breaks + 1;
        if (std::ranges::all_of(out.cells, &std::string::empty)) continue;
        std::ranges::for_each(out.cells, take_mark_away);
        return out;
    }
    return std::nullopt;
}

std::string csv_head(const CsvShape& shape) { return names_of(shape, ",") + "\r\n"; }

std::optional<boost::json::array> rows_from_csv(std::string_view csv, const CsvShape& shape, std::vector<std::size_t>& lines,
                                                std::vector<CsvFault>& faults) {
    CsvReader reader(csv);
    const auto header = reader.next();
    if (!header) {
        faults.push_back(reader.fault() ? *reader.fault()
                                        : CsvFault{1, fmt::format("the first line must name the columns: {},...", shape.needs)});
        return std::nullopt;
    }
    std::vector<const CsvColumn*> columns;
    for (const auto& h : header->cells) {
        const auto it = std::ranges::find(shape.columns, std::string_view(h), &CsvColumn::name);
        columns.push_back(it == shape.columns.end() ? nullptr : &*it);
        if (it == shape.columns.end())
            faults.push_back({header->number, fmt::format("there is no column {}: use {}", h, names_of(shape, ", "))});
        else if (std::ranges::count(columns, &*it) > 1)
            faults.push_back({header->number, fmt::format("the column {} is there twice", h)});
    }
    if (!faults.empty()) return std::nullopt;
    boost::json::array out;
    while (faults.size() < most_kept) {
        auto line = reader.next();
        if (!line) break;
        if (line->cells.size() > columns.size()) {
            faults.push_back({line->number, fmt::format("{} cells, but {} columns", line->cells.size(), columns.size())});
            continue;
        }
        boost::json::object o;
        bool good = true;
        for (std::size_t i = 0; i < line->cells.size(); ++i) {
            std::string& cell = line->cells[i];
            if (cell.empty()) continue;
            if (!columns[i]->number) {
                o[columns[i]->name] = cell;
                continue;
            }
            std::string digits = cell;
            if (reader.separator() != ',' && std::ranges::count(digits, ',') == 1 && digits.find('.') == std::string::npos)
                std::ranges::replace(digits, ',', '.');
            double number = 0;
            const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
            if (error != std::errc() || end != digits.data() + digits.size()) {
                faults.push_back({line->number, fmt::format("{}: \"{}\" is no number", columns[i]->name, cell)});
                good = false;
                continue;
            }
            o[columns[i]->name] = number;
        }
        if (!good) continue;
        out.push_back(std::move(o));
        lines.push_back(line->number);
        if (out.size() > shape.most) {
            faults.push_back({line->number, fmt::format("more than {} {}", shape.most, shape.what)});
            return out;
        }
    }
    if (reader.fault()) faults.push_back(*reader.fault());
    return out;
}

}  // namespace axisgate
