// Sample, AxisFeedback, DriveLink, Notice: what is now known of a drive, on its way up.
// In: made by adapters from frames. Out: engine, image, store and doors.
// Never invented: every field comes from something the drive said, and `at` is when it was said. One field may be computed, and says so:
// the demand.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/core/command.hpp"
#include "gateway/core/drive_limits.hpp"
#include "gateway/core/drive_watchdog.hpp"
#include "gateway/core/ids.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/core/value.hpp"

namespace axisgate {

enum class Quality : std::uint8_t {
    unknown,  ///< never seen
    good,     ///< said by the drive (or its twin) recently
    stale     ///< said once; too old to be trusted
};

/// One parameter value that a drive reported, asked for or not.
struct Sample {
    AxisId axis = no_axis;
    Point point;
    Value value;
    Quality quality = Quality::good;
    Instant at{};
    std::uint32_t source = 0;  ///< who spoke for the axis then (AxisPicture::source); filled in by the engine
};

/// Who says where an axis should be now.
enum class DemandSource : std::uint8_t {
    none,      ///< nobody: the axis is off, or moves by an order that this gateway did not give
    drive,     ///< the drive: it tells its demand, or how far it is behind
    computed,  ///< the gateway, from the order that the drive acknowledged: target, speed, ramps (demand.hpp)
    open_loop  ///< `position` itself: the drive counts the steps that it puts out, and nothing measures whether the shaft follows
};
/// "none", "drive", "computed", "open_loop".
[[nodiscard]] std::string_view name_of(DemandSource source) noexcept;

/// The speed and the ramps that a drive uses where an order names none, as the drive has reported or acknowledged them. 0: not known, and
/// never assumed: an adapter that lets a statement through which may have changed one sets it to 0 and asks the drive for it again.
struct DriveRates {
    std::int64_t velocity = 0;      ///< of a positioning move, increments/s
    std::int64_t acceleration = 0;  ///< increments/s^2
    std::int64_t deceleration = 0;  ///< of a halt and of the end of a move, increments/s^2
    std::int64_t quick_stop = 0;    ///< of a quick stop, increments/s^2
    bool operator==(const DriveRates&) const = default;
};

/// How the motion under way ends, as far as the drive tells it.
enum class Course : std::uint8_t {
    unknown,    ///< the drive does not say
    to_target,  ///< it ends at a target
    endless     ///< it goes on at a speed, or follows a stream, until the drive is told otherwise
};

/// The axis as its drive shows it now: the part of the CiA 402 picture that only the drive can know.
/// An adapter sends the whole struct each time any of it was read anew; `at` is the instant of the newest part.
struct AxisFeedback {
    enum class Power : std::uint8_t { unknown, off, on };
    Power power = Power::unknown;
    bool moving = false;          ///< speed is not zero, or a motion is under way
    bool target_reached = false;  ///< the last commanded motion ended at its target
    bool referenced = false;      ///< the position has a known zero
    bool fault = false;           ///< the drive is in an error that must be reset before it moves again
    bool warning = false;
    bool internal_limit = false;  ///< a limit (switch, software, torque) is active
    bool quick_stopping = false;  ///< the quick-stop ramp runs, or the drive is locked after it
    bool homing = false;          ///< a search for the zero is under way, also while the axis stands between its parts
    bool homing_attained = false;
    bool homing_error = false;
    std::int64_t position = 0;         ///< actual position, increments
    std::int64_t position_demand = 0;  ///< where the axis should be at the instant of `position`, increments; drive and computed only
    DemandSource demand_source = DemandSource::none;
    std::int64_t velocity = 0;        ///< actual velocity, increments/s
    std::uint16_t error_code = 0;     ///< the drive's own, 0 = none
    std::uint32_t native_status = 0;  ///< the drive's own status word(s), as its README says
    /// The state of a drive that has CiA 402's state machine itself, as the bits 0..6 of a status word (0x27: operation enabled); absent:
    /// it knows on and off alone. Other bits are not looked at: they are members of their own here.
    std::optional<std::uint16_t> statusword{};
    /// What answers for it is simulated by somebody else than this gateway: an axis of another gateway that is served by a twin there.
    bool simulated = false;
    /// An input that takes power or motion away acts now (the family's page of data names it under `safe_inputs`): STO, an external stop,
    /// an enable input that is open.
    bool safe_stop = false;
    Course course = Course::unknown;  ///< of the motion under way; of an axis at rest it means nothing
    DriveRates rates{};
    Instant at{};
};

/// How a drive tells of itself where a line has a SYNC: in each so many beats of it.
struct DriveBeats {
    Duration beat{};  ///< between two SYNCs while something moves; at rest they are further apart
    int turns = 0;    ///< 0: it is asked instead
    bool operator==(const DriveBeats&) const = default;
};

/// Whether a drive answers. Sent on every change.
struct DriveLink {
    DriveId drive = no_drive;
    bool online = false;
    std::uint32_t silent_exchanges = 0;  ///< in a row
    Duration retry_pause{};              ///< present pause between attempts while it is silent
    std::string text;                    ///< why, for people
    DriveWatchdog watchdog{};
    DriveLimits limits{};
    DriveBeats beats{};
};

enum class Severity : std::uint8_t { info, warning, alarm };
[[nodiscard]] std::string_view name_of(Severity severity) noexcept;

/// Something that happened and is worth keeping: an alarm, a notification, a drive that does not keep the protocol.
struct Notice {
    Severity severity = Severity::info;
    DriveId drive = no_drive;
    AxisId axis = no_axis;
    std::string kind;       ///< stable word: "alarm", "input", "protocol", "presence", "error_report"...
    std::int32_t code = 0;  ///< the drive's own code, 0 if none
    std::string text;
    Instant at{};
};

}  // namespace axisgate
