// Makes the label of a step from its members while the document is read.
#pragma once

#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <string>

#include "gateway/services/recipes/recipe.hpp"

namespace axisgate {

/// A value as people write it: texts without quotes, numbers as plain decimals (JSON's own writer makes 2.5E0 of 2.5), null as null.
[[nodiscard]] std::string plain_text(const boost::json::value& value);
/// The text of a step behind its number; `body` contains the members under its word. It is stored in the step, at most as long as a label.
[[nodiscard]] std::string step_text(const RecipeStep& step, const boost::json::object& body);

}  // namespace axisgate
