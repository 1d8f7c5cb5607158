// Reads the JSON document of a recipe (schema/recipe.schema.json) with the arguments of one run. All faults are reported together, each
// with its place and a remedy.
#pragma once

#include <boost/json/object.hpp>
#include <optional>
#include <vector>

#include "gateway/services/recipes/recipe.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// Reads and checks a document. `arguments` are the values for "${name}"; nullptr means every parameter's default, or a value of its type,
/// to check the document by itself. Faults of arguments have pointers that begin with /arguments.
[[nodiscard]] std::optional<Recipe> read_recipe(const boost::json::object& document, const boost::json::object* arguments,
                                                std::vector<SiteFault>& faults);
/// The arguments of a run, with defaults for those that were not given.
[[nodiscard]] boost::json::object whole_arguments(const boost::json::object& document, const boost::json::object& arguments);

}  // namespace axisgate
