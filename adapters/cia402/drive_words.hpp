// The text of a status word (6041h), for answers that say why a motion has not begun. The meaning of bits 10, 12 and 13 depends on the
// mode.
#pragma once

#include <cstdint>
#include <string>

namespace axisgate::cia402_drive {

/// "status word 0627h: operation enabled, target reached, set-point not acknowledged".
[[nodiscard]] std::string status_in_words(std::uint16_t statusword, int mode);

}  // namespace axisgate::cia402_drive
