// Mapping, CSV: writes the list as a table and reads it back, with the table reader of gateway/core.
// Reading gives JSON entries for parse_mappings, and every faulty line.
#include <fmt/core.h>

#include <array>

#include "gateway/core/text.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {
namespace {
constexpr std::array<CsvColumn, 14> mapping_columns{{{"id"},
                                                     {"unit", true},
                                                     {"table"},
                                                     {"address", true},
                                                     {"axis"},
                                                     {"point"},
                                                     {"type"},
                                                     {"word_order"},
                                                     {"scale", true},
                                                     {"offset", true},
                                                     {"access"},
                                                     {"length", true},
                                                     {"comment"},
                                                     {"on_overflow"}}};
constexpr CsvShape mapping_shape{mapping_columns, most_mappings, "mappings", "id,unit,table,address,axis,point,type"};
}  // namespace

std::string mappings_to_csv(std::span<const Mapping> mappings) {
    std::string out = csv_head(mapping_shape);
    for (const auto& m : mappings) {
        out +=
            fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", csv_cell(m.id), m.unit, name_of(m.table), m.address,
                        csv_cell(m.axis), csv_cell(m.point), name_of(m.type), name_of(m.word_order), m.scale, m.offset, name_of(m.access),
                        m.type == MapType::string ? std::to_string(m.length) : std::string(), csv_cell(m.comment), name_of(m.on_overflow));
    }
    return out;
}

std::optional<boost::json::array> mappings_from_csv(std::string_view csv, std::vector<std::size_t>& lines, std::vector<CsvFault>& faults) {
    return rows_from_csv(csv, mapping_shape, lines, faults);
}

}  // namespace axisgate
