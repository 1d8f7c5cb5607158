// Recipe wish: the members under a step's word as a typed wish, made once when the document is read.
// In: JSON with its arguments put in. Out: wishes. Never refuses: what is no value stays unknown, and is refused by whoever makes a
// command.
#pragma once

#include <boost/json/object.hpp>

#include "gateway/services/recipes/recipe.hpp"

namespace axisgate {

[[nodiscard]] StepWish read_step_wish(RecipeStep::Kind kind, const boost::json::object& body);
/// Numbers, texts, true and false; unknown: it is none of them.
[[nodiscard]] Value read_scalar(const boost::json::value& value);

}  // namespace axisgate
