// Direct mode: statements of the language that the manual prints, one at a time, as they would be typed at the controller (E-02).
// In: a line of text. Out: what it answers, or why it is none. Never a statement that it does not do: it says that it is not supported.
#pragma once

#include <string>
#include <string_view>

#include "adapters/aposs/twin/macs.hpp"

namespace axisgate::aposs {

struct DirectAnswer {
    std::string fault;  ///< empty: done
    std::string text;   ///< of APOS, GET and the like
};
/// `SET NAME [x(n)] value`, `SET NAME v1 / v2`, `GET NAME [x(n)]`, `SAVEPROM`, `ERRCLR`, `MOTOR ON|OFF|STOP [x(n)]`, `POSA`, `POSR`,
/// `CVEL`, `VEL`, `ACC`, `DEC`, `OUTDA` with `[x(n)] value`, `CSTART`, `HOME`, `DEFORIGIN`, `DEFMORIGIN`, `SYNCV`, `SYNCP`, `SYNCM`,
/// `APOS`, `CPOS`, `MAPOS`, `SYNCERR`, `SYNCSTAT` with `[x(n)]`, `CANINI`, `CANDEL -1`, `OUT n v`, `PULSACC v`, `PULSVEL v`, `SYSVAR[n]`,
/// `SYSVAR[n] = v`. Without x(n): axis 1 (E-47).
[[nodiscard]] DirectAnswer direct(Macs& macs, std::string_view line, Instant now);

}  // namespace axisgate::aposs
