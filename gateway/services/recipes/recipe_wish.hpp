// Makes the typed request of a step from the members under its word, once, when the document is read. A wrong value stays unknown here and
// is refused where the command is made.
#pragma once

#include <boost/json/object.hpp>

#include "gateway/services/recipes/recipe.hpp"

namespace axisgate {

[[nodiscard]] StepWish read_step_wish(RecipeStep::Kind kind, const boost::json::object& body);
/// Numbers, texts, true and false; unknown for anything else.

}  // namespace axisgate
