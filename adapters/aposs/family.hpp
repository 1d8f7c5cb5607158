// Family aposs: MACS controllers on CANopen.
// In: nothing. Out: the family. Never a step of a protocol: drives of this family are served by the adapter of CiA 402 drives.
#pragma once

#include "gateway/core/family.hpp"

namespace axisgate {

/// What a MACS has otherwise is the member "dialect" of its page: its parameters are at 2300h, and VELMAX (2300h:02) is one that every axis
/// has, by which a search knows it. Its EPROM lasts for about 10 000 writes [L81].
const Family& family_aposs();

}  // namespace axisgate
