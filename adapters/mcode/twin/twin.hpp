// The embedded model of a Lexium drive that runs MCode: immediate mode, stored programs, motion.
// In: the line's bytes, time, the tester's hand. Out: bytes; its non-volatile memory.
// Never includes the adapter or its framing code: it is the second, independent reading of the manual.
#pragma once

#include <memory>

#include "gateway/core/twin.hpp"

namespace axisgate {
class Catalogue;
}

namespace axisgate::mcode {

/// Makes one drive, without power until `power_on`.
///
/// `setup.address`: `!` for single mode; one of a-z A-Z 0-9 for a drive that comes with that DN and PY = 1. FD makes it `!` again.
/// `setup.bit_rate`: factory value of BD if it is 4800, 9600, 19200, 38400 or 115200, and the rate at which the twin hears; another BD
///   that is saved makes it deaf after the reset. Other rates, and 0, are heard always.
/// `setup.options`: the line's and the drive's; other names are left alone:
///   "product"   "LMDC" (default, closed loop), "LMDO" (open loop), "LMM" (motion module)
///   "ethernet"  "on" (also "true", "1"; default "off"): MCode over TCP or UDP 503; the commands of the serial link are refused with error
///   37 [L1173-1191]
///   "nema"      "17", "23" (default), "34"
///   "pad"       "on": real numbers are filled with blanks to the width of PF; default "off", as every printed reply is (E-12)
///   "log_base"  "2": LO is the logarithm to base 2; default "e", the only printed figure (E-15)
[[nodiscard]] std::unique_ptr<Twin> make_twin(const Catalogue& catalogue, const TwinSetup& setup);

}  // namespace axisgate::mcode
