// Error text: errno as words that do not depend on the locale, for example "No such device (19)".
#pragma once

#include <string>

namespace axisgate {

[[nodiscard]] std::string error_text(int error);

}  // namespace axisgate
