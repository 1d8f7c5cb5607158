// The texts of steps and conditions, and the evaluation of conditions. recipe_read.cpp reads the document.
#include "gateway/services/recipes/recipe.hpp"

#include <fmt/core.h>

#include <cmath>

#include "gateway/services/recipes/recipe_words.hpp"

namespace axisgate {
using Kind = RecipeStep::Kind;
using Op = RecipeCondition::Op;

std::string_view name_of(Op op) noexcept {
    for (const auto& [o, word] : recipe_comparisons) {
        if (o == op) return word;
    }
    return "is";
}

std::string_view name_of(Kind kind) noexcept {
    for (const auto& w : recipe_words) {
        if (w.kind == kind) return w.word;
    }
    return "message";
}

bool is_motion(const RecipeStep& s) noexcept {
    if (s.kind == Kind::home || s.kind == Kind::action || s.kind == Kind::write_register) return true;
    switch (word_of(s)) {
        case CommandWord::home:
        case CommandWord::move_absolute:
        case CommandWord::move_relative:
        case CommandWord::move_velocity:
            return true;
        default:
            return false;
    }
}

CommandWord word_of(const RecipeStep& s) noexcept {
    const auto* wish = std::get_if<CommandWish>(&s.wish);
    return wish ? wish->word : CommandWord::missing;
}

std::string to_text(const RecipeCondition& c) {
    return fmt::format("{} {}{} {} {}{}", c.axis, c.reads_drive() ? "parameter " : "", c.point, name_of(c.op), to_text(c.value),
                       c.tolerance > 0 ? fmt::format(" within {}", c.tolerance) : std::string());
}

std::optional<bool> holds(const RecipeCondition& c, const Value& v) {
    const auto a = as_number(v), b = as_number(c.value);
    if (c.op == Op::is || c.op == Op::is_not) {
        bool same = false;
        if (a && b) {
            same = *a == *b || std::fabs(*a - *b) <= c.tolerance;
        } else if (std::holds_alternative<std::string>(v) && std::holds_alternative<std::string>(c.value)) {
            same = v == c.value;
        } else {
            return std::nullopt;
        }
        return same == (c.op == Op::is);
    }
    if (!a || !b) return std::nullopt;
    switch (c.op) {
        case Op::at_least:
            return *a >= *b;
        case Op::at_most:
            return *a <= *b;
        case Op::above:
            return *a > *b;
        default:
            return *a < *b;
    }
}

}  // namespace axisgate
