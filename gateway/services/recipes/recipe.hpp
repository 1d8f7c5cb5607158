// Recipe: a named sequence of steps (set a parameter, move, wait for a state, check, if, repeat) as a checked value: what each step wishes
// is typed once, when the document is read with the arguments of a run. Never asks a drive: whether an axis or a parameter exists is for
// whoever runs it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gateway/core/instant.hpp"
#include "gateway/core/value.hpp"
#include "gateway/services/command_wish.hpp"

namespace axisgate {

struct AxisPointRow;

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
    std::string point;                  ///< name of a row of the table of points ("state", "position", "moving"), or a parameter's id
    const AxisPointRow* row = nullptr;  ///< of that table; null: `point` is a parameter, which is read from the drive
    Op op = Op::is;
    Value value;
    double tolerance = 0;  ///< for `is` and `is_not` with numbers
    [[nodiscard]] bool reads_drive() const noexcept { return row == nullptr; }
};
[[nodiscard]] std::string_view name_of(RecipeCondition::Op op) noexcept;
/// "feeder state is operation_enabled"
[[nodiscard]] std::string to_text(const RecipeCondition& condition);
/// Nothing if the value is not known or cannot be compared with what the condition asks for.
[[nodiscard]] std::optional<bool> holds(const RecipeCondition& condition, const Value& value);

// What steps wish, with names as they are written and values as they came; unknown: what stands there is no value.
struct ParameterWish {
    std::string parameter;
    Value value{};  ///< of `set_parameter`
};
struct ActionWish {
    std::string name, argument;
};
struct RegisterWish {
    int unit = 0, address = 0;
    std::optional<std::string> type{};  ///< of the register, if it is said; empty: what stands there is no text
    Value value{};
};
struct SimulateWish {
    std::string input;
    Value value;
};
using StepWish = std::variant<std::monostate, ParameterWish, CommandWish, ActionWish, RegisterWish, SimulateWish>;

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
    std::string axis;         ///< the axis it is about; of write_register: filled in by whoever knows the register map
    std::string what;         ///< what people read of it behind its number: "set_parameter AC of feeder = 20000"
    StepWish wish;            ///< none of enable, disable, and of what is no command
    bool until_done = false;  ///< the step ends when the drive is done, not when it has acknowledged
    Duration limit{};         ///< longest time for it
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
/// The command's word of `command` and `home`; `missing` for every other step.
[[nodiscard]] CommandWord word_of(const RecipeStep& step) noexcept;

struct Recipe {
    std::string description;
    Duration limit{};         ///< for the whole run
    bool quick_stop = false;  ///< how axes are stopped when the run does not come to its end; else halt
    std::vector<RecipeStep> steps;
    std::size_t count = 0;  ///< of all steps
};

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
