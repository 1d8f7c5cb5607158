// Reads the value by the table, except for the age and the axis' number, which are not in the picture. The value keeps no reference to the
// picture.
#include "gateway/services/recipes/recipe_point.hpp"

#include <algorithm>

namespace axisgate {
namespace {
constexpr std::string_view age = "age_ms", axis_number = "number";

static_assert(std::ranges::all_of(axis_point_table,
                                  [](const AxisPointRow& row) {
                                      return row.recipe == PointInRecipe::no || row.document != PointInDocument::composed ||
                                             row.name == age;
                                  }),
              "a point of recipes is one value");
}  // namespace

Value recipe_point(const AxisPointRow& row, const AxisPicture& p, const AxisSpec& spec, std::int64_t age_ms) {
    const bool answers = p.ever_seen && (p.flags & flag_stale) == 0 && (p.flags & flag_online) != 0;
    if (row.recipe == PointInRecipe::no || (row.recipe == PointInRecipe::while_answering && !answers)) return {};
    if (row.name == age) return age_ms;
    if (row.name == axis_number) return std::int64_t{spec.number};  // from the site, because there may be no picture yet
    const PointValue v = said(row, p, spec.increments_per_unit);
    if (const auto* b = std::get_if<bool>(&v)) return *b;
    if (const auto* i = std::get_if<std::int64_t>(&v)) return *i;
    if (const auto* d = std::get_if<double>(&v)) return *d;
    if (const auto* s = std::get_if<std::string_view>(&v)) return std::string(*s);
    return {};
}

}  // namespace axisgate
