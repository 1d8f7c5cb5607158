// The register image for people: words and bits with the names that the site gives them, and the site's mappings as lists. The values are
// the answer of the image; refusals have the codes of the Modbus exceptions.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/registers/register_lists.hpp"
#include "gateway/registers/register_map.hpp"
#include "gateway/registers/unit_map.hpp"
#include "gateway/services/ports/site.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {

[[nodiscard]] std::optional<MapTable> map_table_named(std::string_view name);
/// The values of the standard map except for the parameter channel, which comes last.
[[nodiscard]] std::span<const registers::RegisterRow> standard_points();
/// Registers 18-19 of the standard map, as text.
[[nodiscard]] std::string mapping_revision_text(const Site& site);

struct RegisterRange {
    std::int64_t unit = 1;
    MapTable table = MapTable::holding_registers;
    std::uint16_t address = 0, count = 1;
};
/// The content of a range, or the exception, with the values that lie completely in it. `standard_order` is that of the standard map's
/// 32-bit values.
[[nodiscard]] boost::json::object register_document(const SiteState& site, const RegisterRange& range, const registers::RegisterRead& read,
                                                    MapWordOrder standard_order);
/// The mappings by unit, table and address, each with its unit.
[[nodiscard]] std::vector<ListedMapping> listed_mappings(const SitePort& sites, const SiteState& site);

}  // namespace axisgate
