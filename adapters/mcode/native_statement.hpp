// Statement: one line of a program judged without a drive: its words, names, form, operands and figures.
// In: the text of a statement, the language, the names that its program declares. Out: what is wrong with it, or nothing.
// Never executes: what depends on the state of a drive (a clock type, an order of two limits) is the drive's to refuse.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "adapters/mcode/native_language.hpp"

namespace axisgate::mcode {

/// Names of the user in upper case, wherever in the text they are declared.
struct Names {
    std::set<std::string, std::less<>> labels, variables;
    bool numeric_entry = false;  ///< NE=1: a bare number repeats the last motion [L4464]
};

/// Where a statement stands: typed, or within PG.
enum class Place : std::uint8_t { immediate, program };

/// Why the drive could not take or obey it ("MA: a comma is missing before 2"); empty: nothing speaks against it. LB and VA are judged by
/// their form; whether a name may be declared is the program's matter.
[[nodiscard]] std::string statement_fault(std::string_view statement, const Language& language, const Names& names, Place place);

/// Where the comment begins: an apostrophe outside of quotes [L626]; a backslash or backtick as printed listings have it (E-7). npos: none.
[[nodiscard]] std::size_t comment_at(std::string_view line) noexcept;

}  // namespace axisgate::mcode
