// Error text: errno as words that do not depend on the locale.
// In: an errno value. Out: "No such device (19)". Never allocates more than the text.
#pragma once

#include <string>

namespace axisgate {

[[nodiscard]] std::string error_text(int error);

}  // namespace axisgate
