// The embedded model of the UIROBOT UIM342 drive: byte-exact on the wire, on CAN and as 16-byte UIMessages.
// In: the line's frames, time, the tester's hand. Out: frames; its non-volatile memory.
// Never includes the adapter or its packing code: it is the second, independent reading of the manual.
#pragma once

#include <memory>

#include "gateway/core/twin.hpp"

namespace axisgate {
class Catalogue;
}

namespace axisgate::uim342 {

/// Makes one drive, without power until `power_on`.
///
/// `setup.address`: node ID 5..126 in decimal (others: 5); PP[7] of the memory given to `power_on` goes before it.
/// `setup.kind`: LineKind::can for 29-bit frames, LineKind::bytes for UIMessages.
/// `setup.bit_rate`: the rate of the bus and factory value of PP[5] if it is 1000000, 800000, 500000, 250000 or 125000, else PP[5] = 2
///   (500 kbit/s). After a reboot with another PP[5] the twin neither hears nor is heard on that bus; where the rate is none of these, or
///   the line carries bytes, PP[5] is stored only.
/// `setup.options`: the line's and the drive's; other names are left alone:
///   "crc"     "auto" (default: both), "12", "13": bytes that the CRC of a UIMessage covers; "none": the host speaks without. Messages
///   without
///             a CRC are heard with every value, and answers go back as they were asked: this is for what comes before a question.
///   "model"   "342XS" (default), "342S", "342C02", "342C04", "342C08", "342H08": what ML says [L1143-1148].
/// `setup.freedoms`: those of the page that are not common to all families (manners.hpp); absent ones have the manual's value.
[[nodiscard]] std::unique_ptr<Twin> make_twin(const Catalogue& catalogue, const TwinSetup& setup);

}  // namespace axisgate::uim342
