// Handshake: what an `until` step waits for when a mode is entered, a set-point given or a homing begun, and what the drive shows instead.
// In: answers of the drive, what is known of its axis, the job. Out: whether the step is over; words for one that is not. Never sends.
#pragma once

#include <string>

#include "adapters/cia402/drive_plans.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {

/// The drive has acknowledged this control word.
void word_taken(AxisKnown& known, Job& job, const Step& step, Instant now);
/// The step is over: its value is here, or what stands for it.
[[nodiscard]] bool met(AxisKnown& known, Job& job, const Step& step, const canopen::SdoEnd& end, Instant now);
/// What the axis does tells that a set-point was taken which status bit 12 does not acknowledge.
[[nodiscard]] bool has_begun(const AxisKnown& known, const Job& job);
/// The answer will say so.
void unacknowledged(Job& job);
/// Why a step has come to its end without its value.
[[nodiscard]] std::string not_met(const AxisKnown& known, const Step& step, const canopen::SdoEnd& end);

}  // namespace axisgate::cia402_drive
