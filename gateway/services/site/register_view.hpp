// Register view: the register image as people read it: words and bits with what the site says they are, and the site's mappings as lists.
// In: bytes of the image, the site. Out: documents, rows. Never renders a register: what is shown is what the image answers, refusals under
// Modbus' exception codes.
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
/// Of the standard map, what is a value of its own: all but the parameter channel, which comes last.
[[nodiscard]] std::span<const registers::RegisterRow> standard_points();
/// Registers 18-19 of the standard map, as text.
[[nodiscard]] std::string mapping_revision_text(const Site& site);

struct RegisterRange {
    std::int64_t unit = 1;
    MapTable table = MapTable::holding_registers;
    std::uint16_t address = 0, count = 1;
};
/// What was read of a range, or the exception, with the values that lie whole in it. `standard_order`: of the standard map's 32-bit values.
[[nodiscard]] boost::json::object register_document(const SiteState& site, const RegisterRange& range, const registers::RegisterRead& read,
                                                    MapWordOrder standard_order);
/// The mappings by unit, table and address, with what each is measured in.
[[nodiscard]] std::vector<ListedMapping> listed_mappings(const SitePort& sites, const SiteState& site);

}  // namespace axisgate
