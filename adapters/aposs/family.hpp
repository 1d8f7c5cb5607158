// Family aposs: what a MACS has otherwise than a CiA 402 drive, on whose adapter it stands.
// In: nothing. Out: the dialect. Never a step of a protocol.
#pragma once

#include "adapters/cia402/drive_node.hpp"
#include "gateway/core/family.hpp"

namespace axisgate {

const Family& family_aposs();

namespace aposs {

/// What the manual does not print is marked in the catalogue; what is left to say here: its parameters are at 2300h, and VELMAX (2300h:02)
/// is one that every axis has, by which a search knows it. Its EPROM lasts for about 10 000 writes [L81].
inline constexpr cia402_drive::Dialect dialect{.noun = "MACS controller",
                                               .channels = cia402_drive::most_axes,
                                               .profile_optional = true,
                                               .mark = {0x2300, 2},
                                               .errors_in_low_byte = true,
                                               .between_stores = std::chrono::seconds(60),
                                               .places_move = true};

}  // namespace aposs
}  // namespace axisgate
