// MACS controllers on CANopen. Their drives are served by the adapter of CiA 402 drives.
#pragma once

#include "gateway/core/family.hpp"

namespace axisgate {

/// The differences of a MACS are in the member "dialect" of its catalogue: its parameters are at 2300h, and a search recognises it by
/// VELMAX (2300h:02), which every axis has. Its EPROM lasts for about 10 000 writes [L81].
const Family& family_aposs();

}  // namespace axisgate
