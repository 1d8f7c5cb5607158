// Recipe label: what people call a step, made of its members while the document is read.
// In: JSON with its arguments put in. Out: texts.
#pragma once

#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <string>

#include "gateway/services/recipes/recipe.hpp"

namespace axisgate {

/// A value as people write it: texts without quotes, numbers as plain decimals (JSON's own writer has 2.5 as 2.5E0), null as null.
[[nodiscard]] std::string plain_text(const boost::json::value& value);
/// What people read of a step behind its number; `body`: the members under its word. It is kept in the step, at most as long as a label.
[[nodiscard]] std::string step_text(const RecipeStep& step, const boost::json::object& body);

}  // namespace axisgate
