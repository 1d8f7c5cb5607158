// Recipe: a named sequence of steps (set a parameter, move, wait for a state, check, if, repeat) as a checked value.
// In: the JSON document (schema/recipe.schema.json) and the arguments of one run. Out: steps with the arguments put in, or all faults at
// once, each with its place and a way to mend it. Never asks a drive: whether an axis or a parameter exists is for whoever runs it.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/instant.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

// Bounds. What lies beyond one is a fault of the document, never cut.
inline constexpr std::size_t most_recipe_steps = 500;        ///< nested ones counted
inline constexpr std::size_t most_recipe_nesting = 8;        ///< `if` and `repeat` in one another
inline constexpr std::int64_t most_recipe_repeats = 10'000;  ///< of one `repeat`
inline constexpr std::size_t most_recipe_parameters = 64;
inline constexpr std::size_t most_recipe_text_bytes = 4096;   ///< one text: a value, a message, a comment
inline constexpr std::size_t most_recipe_bytes = 256 * 1024;  ///< the document
inline constexpr std::size_t most_recipe_label_bytes = 200;   ///< one line; a longer one is cut and ends with "..."
inline constexpr double most_recipe_seconds = 86'400;         ///< of the run, and of every wait

/// What a wait, a check, an `if` or an `until` looks at.
struct RecipeCondition {
    enum class Op : std::uint8_t { is, is_not, at_least, at_most, above, below };
    std::string axis;
    std::string point;       ///< a member of the axis' document ("state", "position", "moving"), or a parameter's id
    bool parameter = false;  ///< `point` is a parameter: it is read from the drive
    Op op = Op::is;
    boost::json::value value;
    double tolerance = 0;  ///< for `is` and `is_not` with numbers
};
[[nodiscard]] std::string_view name_of(RecipeCondition::Op op) noexcept;
/// "feeder state is operation_enabled"
[[nodiscard]] std::string to_text(const RecipeCondition& condition);
/// Nothing if the value is not known or cannot be compared with what the condition asks for.
[[nodiscard]] std::optional<bool> holds(const RecipeCondition& condition, const boost::json::value& value);

struct RecipeStep {
    enum class Kind : std::uint8_t {
        set_parameter,
        read_parameter,
        enable,
        disable,
        home,
        command,
        action,
        write_register,
        simulate,  ///< an outside condition of a simulated drive: a fault, a switch, a load
        wait_for,
        check,
        wait,
        branch,  ///< "if"
        repeat,
        message
    };
    Kind kind = Kind::message;
    std::size_t row = 0;  ///< its place among all steps, in the order of the document
    std::string pointer;  ///< "/steps/2/if/then/0"
    std::string comment;
    std::string axis;          ///< the axis it is about; of write_register: filled in by whoever knows the register map
    boost::json::object body;  ///< the members under its word
    bool until_done = false;   ///< the step ends when the drive is done, not when it has acknowledged
    Duration limit{};          ///< longest time for it
    std::optional<RecipeCondition> condition;
    std::int64_t times = 1;
    std::string text;
    std::vector<RecipeStep> steps, otherwise;  ///< of `if`: then and else; of `repeat`: steps
};
/// The step's word in the document: "set_parameter", "if", ...
[[nodiscard]] std::string_view name_of(RecipeStep::Kind kind) noexcept;
/// What people call it: "Step 4.3 (pass 2 of 5): set_parameter AC of feeder = 20000". `pass`: of the repeats around it; may be empty.
[[nodiscard]] std::string label_of(const RecipeStep& step, std::string_view pass);
/// Whether it can set its axis in motion.
[[nodiscard]] bool is_motion(const RecipeStep& step) noexcept;

struct Recipe {
    std::string description;
    Duration limit{};         ///< for the whole run
    bool quick_stop = false;  ///< how axes are stopped when the run does not come to its end; else halt
    std::vector<RecipeStep> steps;
    std::size_t count = 0;  ///< of all steps
};

/// Reads and checks a document. `arguments`: what stands for "${name}"; nullptr: every parameter's default, or a value of its type, to
/// check the document by itself. Faults of arguments have pointers that begin with /arguments.
[[nodiscard]] std::optional<Recipe> read_recipe(const boost::json::object& document, const boost::json::object* arguments,
                                                std::vector<SiteFault>& faults);
/// The arguments of a run with the defaults of those that were not given.
[[nodiscard]] boost::json::object whole_arguments(const boost::json::object& document, const boost::json::object& arguments);

/// Calls `f(step)` for every step, outer ones before inner ones.
template <class Steps, class F>
void for_each_step(Steps& steps, F&& f) {
    for (auto& s : steps) {
        f(s);
        for_each_step(s.steps, f);
        for_each_step(s.otherwise, f);
    }
}

}  // namespace axisgate
