// Register lists: the site's user maps on paper: CSV, a page to print, and structures for a PLC.
// In: mappings in order of unit, table and address, with what they are measured in; the revision of the map. Out: texts.
// Never reads a value, and never leaves a gap inside a structure: what stands at an address stands at that offset.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gateway/site/mapping.hpp"

namespace axisgate {

struct ListedMapping {
    Mapping mapping;
    std::string unit;  ///< of the point's value, before scale and offset; empty: none
};

/// What a point is measured in: "mm", "mm/s" for those in the axis' unit, increments for the others; empty: nothing.
[[nodiscard]] std::string unit_of(AxisPoint point, std::string_view axis_unit);
/// As PLC manuals count, from 1: 40001 is holding register 0, 30001 input register 0, 10001 discrete input 0, 00001 coil 0; six digits
/// where five do not reach.
[[nodiscard]] std::string register_number(MapTable table, std::uint32_t address);

[[nodiscard]] std::string list_csv(const std::vector<ListedMapping>& list, const std::string& revision);
[[nodiscard]] std::string list_html(const std::vector<ListedMapping>& list, const std::string& revision);
/// IEC 61131-3: one structure for each run of addresses without a gap, each member as many registers long as its mapping.
[[nodiscard]] std::string list_st(const std::vector<ListedMapping>& list, const std::string& revision);

}  // namespace axisgate
