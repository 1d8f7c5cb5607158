// The words of a recipe's document as tables: those of its steps, with the members that each may have, and those of comparisons.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "gateway/services/recipes/recipe.hpp"

namespace axisgate {

struct RecipeWord {
    RecipeStep::Kind kind;
    std::string_view word;
    std::string_view members;  ///< with blanks around each
};
inline constexpr std::array recipe_words{
    RecipeWord{RecipeStep::Kind::set_parameter, "set_parameter", " axis parameter value "},
    RecipeWord{RecipeStep::Kind::read_parameter, "read_parameter", " axis parameter "},
    RecipeWord{RecipeStep::Kind::enable, "enable", " axis wait_s "},
    RecipeWord{RecipeStep::Kind::disable, "disable", " axis wait_s "},
    RecipeWord{RecipeStep::Kind::home, "home", " axis method wait_s "},
    RecipeWord{RecipeStep::Kind::command, "command", " axis command position velocity acceleration deceleration method prepare wait_s "},
    RecipeWord{RecipeStep::Kind::action, "action", " axis name argument wait_s "},
    RecipeWord{RecipeStep::Kind::write_register, "write_register", " unit address type value "},
    RecipeWord{RecipeStep::Kind::simulate, "simulate", " axis input value "},
    RecipeWord{RecipeStep::Kind::wait_for, "wait_for", " axis point parameter is is_not at_least at_most above below tolerance timeout_s "},
    RecipeWord{RecipeStep::Kind::check, "check", " axis point parameter is is_not at_least at_most above below tolerance text "},
    RecipeWord{RecipeStep::Kind::wait, "wait_s", ""},
    RecipeWord{RecipeStep::Kind::branch, "if", " condition then else "},
    RecipeWord{RecipeStep::Kind::repeat, "repeat", " times until steps "},
    RecipeWord{RecipeStep::Kind::message, "message", ""},
};
inline constexpr std::array recipe_comparisons{std::pair{RecipeCondition::Op::is, std::string_view("is")},
                                               std::pair{RecipeCondition::Op::is_not, std::string_view("is_not")},
                                               std::pair{RecipeCondition::Op::at_least, std::string_view("at_least")},
                                               std::pair{RecipeCondition::Op::at_most, std::string_view("at_most")},
                                               std::pair{RecipeCondition::Op::above, std::string_view("above")},
                                               std::pair{RecipeCondition::Op::below, std::string_view("below")}};

}  // namespace axisgate
