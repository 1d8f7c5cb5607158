// Assembly, CSV: writes the site's own assemblies as a table and reads them back, with the table reader of gateway/core.
// Reading gives JSON entries in the form of a site, and every faulty line. Assemblies of profiles are not included.
#include <fmt/core.h>

#include <array>

#include "gateway/core/text.hpp"
#include "gateway/site/assembly.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {
namespace {
constexpr std::array<CsvColumn, 8> assembly_columns{
    {{"instance", true}, {"direction"}, {"unit", true}, {"table"}, {"address", true}, {"registers", true}, {"byte_order"}, {"comment"}}};
constexpr CsvShape assembly_shape{assembly_columns, most_assemblies, "assemblies", "instance,direction,unit,table,address,registers"};
}  // namespace

std::string assemblies_to_csv(std::span<const AssemblySpec> assemblies) {
    std::string out = csv_head(assembly_shape);
    for (const auto& a : assemblies) {
        out += fmt::format("{},{},{},{},{},{},{},{}\r\n", a.instance, name_of(a.direction), a.unit, name_of(a.table), a.address,
                           a.registers, name_of(a.order), csv_cell(a.comment));
    }
    return out;
}

std::optional<boost::json::array> assemblies_from_csv(std::string_view csv, std::vector<std::size_t>& lines,
                                                      std::vector<CsvFault>& faults) {
    return rows_from_csv(csv, assembly_shape, lines, faults);
}

}  // namespace axisgate
