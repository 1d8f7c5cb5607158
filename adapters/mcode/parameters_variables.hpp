// Variables: the user variables of a drive (VA): as parameters of its axis, as rows of its own listing, as lines that set them.
// In: the drive's option `variables`, what PR UV prints, a person's text. Out: a catalogue, names, lines, what is wrong in words.
// Never declares one in a drive: that is its program's or its user's business.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "adapters/mcode/native_language.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::mcode {

/// What stands before the name in the id of a parameter: "UV.Q1".
inline constexpr std::string_view variable_prefix = "UV.";
/// Labels and variables that a drive holds together [L599].
inline constexpr std::size_t most_variables = 192;

/// The family's page with a parameter `UV.<name>` for each name of the option `variables`, "Q1,K2:mm": 32 bits [L543], with a unit for
/// people behind a colon. Nothing is made without that option.
[[nodiscard]] OwnCatalogue own_catalogue(const CatalogueWish& wish);

/// Names of the global variables (G) in a listing, `Q1 = G 25` each [L5965]; those of programs (L) are made anew at each run [L554].
[[nodiscard]] std::vector<std::string> global_variables(std::string_view listing);
[[nodiscard]] std::vector<std::string> listed_variables(std::string_view listing);

/// `Q1=25`, or a row of the drive's own listing, as a line that sets the variable; what is wrong with it in `fault`. Rows of local
/// variables give nothing.
[[nodiscard]] std::string variable_line(std::string_view row, const Language& language, std::string& fault);

}  // namespace axisgate::mcode
