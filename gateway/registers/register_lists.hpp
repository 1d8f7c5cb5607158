// The site's user maps as documents: CSV, a page to print, and structures for a PLC. In a structure the offset of a member is its address,
// without gaps.
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

/// The unit of a point: "mm", "mm/s" for points in the axis' unit, increments for the others; empty: none.
[[nodiscard]] std::string unit_of(AxisPoint point, std::string_view axis_unit);
/// Counted from 1, as in PLC manuals: 40001 is holding register 0, 30001 input register 0, 10001 discrete input 0, 00001 coil 0; six digits
/// where five are not sufficient.
[[nodiscard]] std::string register_number(MapTable table, std::uint32_t address);

[[nodiscard]] std::string list_csv(const std::vector<ListedMapping>& list, const std::string& revision);
[[nodiscard]] std::string list_html(const std::vector<ListedMapping>& list, const std::string& revision);
/// IEC 61131-3: one structure for each contiguous range of addresses; each member has the length of its mapping.
[[nodiscard]] std::string list_st(const std::vector<ListedMapping>& list, const std::string& revision);

}  // namespace axisgate
