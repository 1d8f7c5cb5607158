// Words of a status word (6041h), for answers that say why a motion has not begun.
// In: the word, the mode that the drive shows. Out: a sentence's part. Bits 10, 12 and 13 mean what they mean in that mode.
#pragma once

#include <cstdint>
#include <string>

namespace axisgate::cia402_drive {

/// "status word 0627h: operation enabled, target reached, set-point not acknowledged".
[[nodiscard]] std::string status_in_words(std::uint16_t statusword, int mode);

}  // namespace axisgate::cia402_drive
