// A recipe as a checked value: a named sequence of steps (set a parameter, move, wait for a state, check, if, repeat). The steps get their
// types when the document is read with the arguments of a run. Whether an axis or a parameter exists is checked later, where the site is
// known.
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

// Bounds. A document that exceeds one is faulty; nothing is cut.
inline constexpr std::size_t most_recipe_steps = 500;        ///< including nested steps
inline constexpr std::size_t most_recipe_nesting = 8;        ///< nesting of `if` and `repeat`
inline constexpr std::int64_t most_recipe_repeats = 10'000;  ///< of one `repeat`
inline constexpr std::size_t most_recipe_parameters = 64;
inline constexpr std::size_t most_recipe_text_bytes = 4096;   ///< of one text: a value, a message, a comment
inline constexpr std::size_t most_recipe_bytes = 256 * 1024;  ///< of the document
inline constexpr std::size_t most_recipe_label_bytes = 200;   ///< of one line; a longer one is cut and ends with "..."
inline constexpr double most_recipe_seconds = 86'400;         ///< of the run, and of every wait

/// The condition of a wait, a check, an `if` or an `until`.
struct RecipeCondition {
    enum class Op : std::uint8_t { is, is_not, at_least, at_most, above, below };
    std::string axis;
    std::string point;                  ///< name of a row of the table of points ("state", "position", "moving"), or a parameter's id
    const AxisPointRow* row = nullptr;  ///< the row of that table; null: `point` is a parameter, which is read from the drive
    Op op = Op::is;
    Value value;
    double tolerance = 0;  ///< for `is` and `is_not` with numbers
    [[nodiscard]] bool reads_drive() const noexcept { return row == nullptr; }
};
[[nodiscard]] std::string_view name_of(RecipeCondition::Op op) noexcept;
/// "feeder state is operation_enabled"
[[nodiscard]] std::string to_text(const RecipeCondition& condition);
/// Empty if the value is unknown or cannot be compared with that of the condition.
[[nodiscard]] std::optional<bool> holds(const RecipeCondition& condition, const Value& value);

// The requests of steps, with names and values as written; unknown: the value in the document has a wrong type.
struct ParameterWish {
    std::string parameter;
    Value value{};  ///< of `set_parameter`
};
struct ActionWish {
    std::string name, argument;
};
struct RegisterWish {
    int unit = 0, address = 0;
    std::optional<std::string> type{};  ///< of the register, if stated; empty: the value in the document is not a text
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
        simulate,  ///< an external condition of a simulated drive: a fault, a switch, a load
        wait_for,
        check,
        wait,
        branch,  ///< "if"
        repeat,
        message
    };
    Kind kind = Kind::message;
    std::size_t row = 0;  ///< its index among all steps, in the order of the document
    std::string pointer;  ///< "/steps/2/if/then/0"
    std::string comment;
    std::string axis;         ///< the axis that it concerns; for write_register filled in where the register map is known
    std::string what;         ///< its text for people, behind its number: "set_parameter AC of feeder = 20000"
    StepWish wish;            ///< empty for enable, disable, and steps that are not commands
    bool until_done = false;  ///< the step ends when the drive is done, not when it has acknowledged
    Duration limit{};         ///< the longest time for it
    std::optional<RecipeCondition> condition;
    std::int64_t times = 1;
    std::string text;
    std::vector<RecipeStep> steps, otherwise;  ///< of `if`: then and else; of `repeat`: steps
};
/// The step's word in the document: "set_parameter", "if", ...
[[nodiscard]] std::string_view name_of(RecipeStep::Kind kind) noexcept;
/// Its label: "Step 4.3 (pass 2 of 5): set_parameter AC of feeder = 20000". `pass` is that of the surrounding repeats; may be empty.
[[nodiscard]] std::string label_of(const RecipeStep& step, std::string_view pass);
/// True if it can set its axis in motion.
[[nodiscard]] bool is_motion(const RecipeStep& step) noexcept;
/// The command's word of `command` and `home`; `missing` for every other step.
[[nodiscard]] CommandWord word_of(const RecipeStep& step) noexcept;

struct Recipe {
    std::string description;
    Duration limit{};         ///< for the whole run
    bool quick_stop = false;  ///< true: axes are stopped by a quick stop when the run ends early; false: by a halt
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
