// Recipe read: the JSON document of a recipe (schema/recipe.schema.json) with the arguments of one run, as a checked value.
// In: JSON. Out: steps with the arguments put in and their wishes typed, or all faults at once, each with its place and a way to mend it.
#pragma once

#include <boost/json/object.hpp>
#include <optional>
#include <vector>

#include "gateway/services/recipes/recipe.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// Reads and checks a document. `arguments`: what stands for "${name}"; nullptr: every parameter's default, or a value of its type, to
/// check the document by itself. Faults of arguments have pointers that begin with /arguments.
[[nodiscard]] std::optional<Recipe> read_recipe(const boost::json::object& document, const boost::json::object* arguments,
                                                std::vector<SiteFault>& faults);
/// The arguments of a run with the defaults of those that were not given.
[[nodiscard]] boost::json::object whole_arguments(const boost::json::object& document, const boost::json::object& arguments);

}  // namespace axisgate
