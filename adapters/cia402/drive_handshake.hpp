// Handshake decides when an `until` step is complete that waits for a mode, for the acknowledgement of a set-point or for the start of
// homing, and states why a step is not complete.
#pragma once

#include <string>

#include "adapters/cia402/drive_plans.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {

/// The drive has acknowledged this control word.
void word_taken(AxisKnown& known, Job& job, const Step& step, Instant now);
/// The step is complete: the drive shows the value, or another fact proves that it was reached.
[[nodiscard]] bool met(AxisKnown& known, Job& job, const Step& step, const canopen::SdoEnd& end, Instant now);
/// The axis moves as ordered, so the drive has accepted a set-point that status bit 12 does not acknowledge.
[[nodiscard]] bool has_begun(const AxisKnown& known, const Job& job);
/// Adds to the answer that the set-point was not acknowledged.
void unacknowledged(Job& job);
/// Why a step has ended without its value.
[[nodiscard]] std::string not_met(const AxisKnown& known, const Step& step, const canopen::SdoEnd& end);

}  // namespace axisgate::cia402_drive
