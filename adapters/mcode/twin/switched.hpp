// Switched: what counts as on in a yes-or-no option of this family.
// In: the option's text. Out: true or false; anything else than the words for on is off.
// Never knows which option it is.
#pragma once

#include <string_view>

namespace axisgate::mcode {

/// `on`, `true` and `1` mean on; `off`, `false`, `0` and everything else mean off.
[[nodiscard]] constexpr bool switched_on(std::string_view text) noexcept { return text == "on" || text == "true" || text == "1"; }

}  // namespace axisgate::mcode
