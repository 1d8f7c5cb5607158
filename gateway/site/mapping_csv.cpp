// Mapping, CSV: the whole list for a spreadsheet and back (RFC 4180: commas, quotes doubled, CR LF or LF).
// In: text. Out: JSON entries for parse_mappings, and every faulty line. A semicolon as separator, and then a comma in numbers, is
// understood, too: spreadsheets of many countries write it.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "gateway/site/mapping.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {

constexpr std::array<std::string_view, 14> columns{"id",         "unit",  "table",  "address", "axis",   "point",   "type",
                                                   "word_order", "scale", "offset", "access",  "length", "comment", "on_overflow"};
constexpr std::size_t longest_line = 4096;

std::string quoted(std::string_view s) {
    // A cell that begins like a formula would be carried out by a spreadsheet.
    const bool formula = !s.empty() && std::string_view("=+-@").find(s.front()) != std::string_view::npos;
    if (!formula && s.find_first_of(",;\"\r\n") == std::string_view::npos) return std::string(s);
    std::string out = formula ? "\"'" : "\"";
    for (const char c : s)
        out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
}

/// One record; `rest` moves behind it. Nothing: a quote is not closed, or the record is too long.
std::optional<std::vector<std::string>> record(std::string_view& rest, char separator, std::size_t& lines) {
    std::vector<std::string> cells(1);
    bool inside = false;
    std::size_t i = 0;
    lines = 1;
    for (; i < rest.size(); ++i) {
        const char c = rest[i];
        if (i > longest_line) return std::nullopt;
        if (inside) {
            if (c == '"' && i + 1 < rest.size() && rest[i + 1] == '"') {
                cells.back() += '"';
                ++i;
            } else if (c == '"') {
                inside = false;
            } else {
                lines += c == '\n' ? 1 : 0;
                cells.back() += c;
            }
        } else if (c == '"' && cells.back().empty()) {
            inside = true;
        } else if (c == separator) {
            cells.emplace_back();
        } else if (c == '\n') {
            ++i;
            break;
        } else if (c != '\r') {
            cells.back() += c;
        }
    }
    if (inside) return std::nullopt;
    rest.remove_prefix(std::min(i, rest.size()));
    return cells;
}

bool is_number_column(std::string_view c) { return c == "unit" || c == "address" || c == "scale" || c == "offset" || c == "length"; }

}  // namespace

std::string mappings_to_csv(std::span<const Mapping> mappings) {
    std::string out;
    for (const auto c : columns)
        out += (out.empty() ? "" : ",") + std::string(c);
    out += "\r\n";
    for (const auto& m : mappings) {
        out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", quoted(m.id), m.unit, name_of(m.table), m.address,
                           quoted(m.axis), quoted(m.point), name_of(m.type), name_of(m.word_order), m.scale, m.offset, name_of(m.access),
                           m.type == MapType::string ? std::to_string(m.length) : std::string(), quoted(m.comment), name_of(m.on_overflow));
    }
    return out;
}

std::optional<json::array> mappings_from_csv(std::string_view csv, std::vector<std::size_t>& line_of, std::vector<CsvFault>& faults) {
    if (csv.starts_with("\xEF\xBB\xBF")) csv.remove_prefix(3);
    const auto first_end = csv.find('\n');
    const std::string_view first = csv.substr(0, first_end);
    const char separator = std::ranges::count(first, ';') > std::ranges::count(first, ',') ? ';' : ',';
    std::size_t line = 1, lines = 1;
    const auto header = record(csv, separator, lines);
    if (!header || (header->size() == 1 && header->front().empty())) {
        faults.push_back({1, "the first line must name the columns: id,unit,table,address,axis,point,type,..."});
        return std::nullopt;
    }
    for (const auto& h : *header) {
        if (std::ranges::find(columns, std::string_view(h)) == columns.end())
            faults.push_back({1, fmt::format("there is no column {}: use id, unit, table, address, axis, point, type, word_order, scale, "
                                             "offset, access, length, comment, on_overflow",
                                             h)});
        if (std::ranges::count(*header, h) > 1) faults.push_back({1, fmt::format("the column {} is there twice", h)});
    }
    if (!faults.empty()) return std::nullopt;
    json::array out;
    line += lines;
    while (!csv.empty() && faults.size() < 1000) {
        const auto cells = record(csv, separator, lines);
        const std::size_t here = line;
        line += lines;
        if (!cells) {
            faults.push_back({here, "a quote is not closed, or the line is longer than 4096 characters"});
            break;
        }
        if (cells->size() == 1 && cells->front().empty()) continue;
        if (cells->size() > header->size()) {
            faults.push_back({here, fmt::format("{} cells, but {} columns", cells->size(), header->size())});
            continue;
        }
        json::object o;
        bool good = true;
        for (std::size_t i = 0; i < cells->size(); ++i) {
            std::string cell = (*cells)[i];
            const std::string& column = (*header)[i];
            if (cell.empty()) continue;
            if (cell.size() > 1 && cell[0] == '\'' && std::string_view("=+-@").find(cell[1]) != std::string_view::npos) cell.erase(0, 1);
            if (!is_number_column(column)) {
                o[column] = cell;
                continue;
            }
            if (separator == ';' && std::ranges::count(cell, ',') == 1 && cell.find('.') == std::string::npos)
                std::ranges::replace(cell, ',', '.');
            double number = 0;
            const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
            if (error != std::errc() || end != cell.data() + cell.size()) {
                faults.push_back({here, fmt::format("{}: \"{}\" is no number", column, (*cells)[i])});
                good = false;
                continue;
            }
            o[column] = number;
        }
        if (!good) continue;
        out.push_back(std::move(o));
        line_of.push_back(here);
        if (out.size() > most_mappings) {
            faults.push_back({here, fmt::format("more than {} mappings", most_mappings)});
            break;
        }
    }
    return out;
}

}  // namespace axisgate
