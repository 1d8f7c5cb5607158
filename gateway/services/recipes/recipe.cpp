// Recipe: what steps and conditions mean; reading a document is in recipe_read.cpp.
// In: steps, conditions, values. Out: their words, and whether they hold.
#include "gateway/services/recipes/recipe.hpp"

#include <fmt/core.h>

#include <boost/json/serialize.hpp>
#include <cmath>

#include "gateway/services/recipes/recipe_words.hpp"

namespace axisgate {
namespace json = boost::json;
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
    if (s.kind != Kind::command) return false;
    const auto* c = s.body.if_contains("command");
    return c && c->is_string() && (c->get_string().starts_with("move_") || c->get_string() == "home");
}

std::string to_text(const RecipeCondition& c) {
    return fmt::format("{} {}{} {} {}{}", c.axis, c.parameter ? "parameter " : "", c.point, name_of(c.op), plain_text(c.value),
                       c.tolerance > 0 ? fmt::format(" within {}", c.tolerance) : std::string());
}

std::optional<bool> holds(const RecipeCondition& c, const json::value& v) {
    const auto as_number = [](const json::value& x) -> std::optional<double> {
        if (x.is_number()) return x.to_number<double>();
        if (x.is_bool()) return x.get_bool() ? 1.0 : 0.0;
        return std::nullopt;
    };
    const auto a = as_number(v), b = as_number(c.value);
    if (c.op == Op::is || c.op == Op::is_not) {
        bool same = false;
        if (a && b) {
            same = *a == *b || std::fabs(*a - *b) <= c.tolerance;
        } else if (v.is_string() && c.value.is_string()) {
            same = v.get_string() == c.value.get_string();
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
