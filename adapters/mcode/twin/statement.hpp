// Statement: one line of MCode in the form in which it runs: words resolved, constants known, names turned into numbers.
// In: the text of a line and the table of names. Out: a statement, or the error code that the drive gives for such a line.
// Never executes anything.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/mcode/twin/symbols.hpp"
#include "adapters/mcode/twin/token.hpp"
#include "adapters/mcode/twin/value.hpp"
#include "adapters/mcode/twin/words.hpp"

namespace axisgate::mcode::twin {

struct Operand {
    enum class Kind : std::uint8_t { constant, integer_register, float_register, word, symbol };
    Kind kind = Kind::constant;
    std::uint8_t index = 0;  ///< of the register, from 0
    Word word{};
    SymbolId symbol = no_symbol;
    Number number;
};

/// One operand with what stands before it: sign, complement, a function of the firmware 6 [L6550-6767].
struct Term {
    Operator op = Operator::add;  ///< between what stands to the left and this; not used for the first
    std::string prefix;           ///< of `-` and `!`, as written: the one next to the value counts first
    std::optional<Word> function;
    bool operand_minus = false;  ///< sign behind the function, as in AB -R2
    Operand operand;
};

/// Terms are worked off from left to right, without precedence (the manual gives none).
struct Expression {
    std::vector<Term> terms;
};

enum class Comparison : std::uint8_t { truth, equal, different, less, less_equal, greater, greater_equal };

/// One condition: a comparison, or an expression that counts as true when it is not zero [L1356, L1794].
struct Condition {
    Expression left;
    Comparison comparison = Comparison::truth;
    Expression right;
};

/// Where BR, CL, EX, OE and trips lead: a label or an address.
struct Target {
    SymbolId label = no_symbol;
    std::int32_t address = 0;  ///< 0: none given, or `label` counts
    bool given = false;
    bool missing_name = false;  ///< a name that nobody has defined, typed as a line
};

struct PrintItem {
    enum class Kind : std::uint8_t { text, value };
    Kind kind = Kind::value;
    std::string text;  ///< escapes already replaced [L4899-4913]
    Expression value;
};

struct Statement {
    enum class Kind : std::uint8_t {
        empty,        ///< blank or comment
        assign,       ///< word = fields
        assign_name,  ///< symbol = field
        execute,      ///< word with fields
        bare_number,  ///< repeats the last motion when NE = 1 [L4464]
        faulty        ///< `error` when it runs
    };
    Kind kind = Kind::empty;
    Word word{};
    int error = 0;
    bool with_sign = false;  ///< `=` was written
    bool open_end = false;   ///< PR ended by `;`
    SymbolId symbol = no_symbol;
    std::string name;  ///< LB, VA: the name as it was written; DN: the character
    std::optional<Target> target;
    std::optional<Condition> condition;
    std::vector<Expression> fields;
    std::vector<PrintItem> items;
};

/// `define`: the line is stored in a program, so unknown names get a place in the table (they may be defined further down); a typed line
/// gets none. A faulty line is a statement of kind `faulty` with its code: 20, 29, 30, 32, 33, 34, 35, 37 (not here), 38, 60.
[[nodiscard]] Statement compile(std::string_view line, Symbols& symbols, bool define);

/// Length of the printed text of a line that is stored (blanks at both ends are not kept).
[[nodiscard]] std::string_view trimmed(std::string_view line) noexcept;

}  // namespace axisgate::mcode::twin
