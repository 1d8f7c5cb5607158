// Direct mode: the statements of the language that the manual prints, one at a time, as if typed at the controller (E-02). Statements that
// the twin does not carry out are refused as not supported.
#pragma once

#include <string>
#include <string_view>

#include "adapters/aposs/twin/macs.hpp"

namespace axisgate::aposs {

struct DirectAnswer {
    std::string fault;  ///< empty: carried out
    std::string text;   ///< result of APOS, GET and the like
};
/// `SET NAME [x(n)] value`, `SET NAME v1 / v2`, `GET NAME [x(n)]`, `SAVEPROM`, `ERRCLR`, `MOTOR ON|OFF|STOP [x(n)]`, `POSA`, `POSR`,
/// `CVEL`, `VEL`, `ACC`, `DEC`, `OUTDA` with `[x(n)] value`, `CSTART`, `HOME`, `DEFORIGIN`, `DEFMORIGIN`, `SYNCV`, `SYNCP`, `SYNCM`,
/// `APOS`, `CPOS`, `MAPOS`, `SYNCERR`, `SYNCSTAT` with `[x(n)]`, `CANINI`, `CANDEL -1`, `OUT n v`, `PULSACC v`, `PULSVEL v`, `SYSVAR[n]`,
/// `SYSVAR[n] = v`. Without x(n): axis 1 (E-47).
[[nodiscard]] DirectAnswer direct(Macs& macs, std::string_view line, Instant now);

}  // namespace axisgate::aposs
