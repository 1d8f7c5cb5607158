// The data of a drive on their way from the adapter to engine, image, store and doors. Every field comes from a report of the drive, and
// `at` is the instant of the report. Only the demand may be computed, and is marked then.
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
    unknown,  ///< never reported
    good,     ///< reported by the drive (or its twin) recently
    stale     ///< reported once; too old to be trusted
};

/// One parameter value that a drive reported, with or without a request.
struct Sample {
    AxisId axis = no_axis;
    Point point;
    Value value;
    Quality quality = Quality::good;
    Instant at{};
    std::uint32_t source = 0;  ///< the side that served the axis then (AxisPicture::source); filled in by the engine
};

/// The origin of the demand position.
enum class DemandSource : std::uint8_t {
    none,      ///< none: the axis is off, or moves by an order that this gateway did not give
    drive,     ///< the drive reports its demand, or its following error
    computed,  ///< computed by the gateway from the order that the drive acknowledged: target, speed, ramps (demand.hpp)
    open_loop  ///< `position` itself: the drive counts the steps that it puts out, and the shaft is not measured
};
/// "none", "drive", "computed", "open_loop".
[[nodiscard]] std::string_view name_of(DemandSource source) noexcept;

/// The speed and the ramps that a drive uses if an order names none, as the drive has reported or acknowledged them. 0: unknown. They are
/// never assumed: if an adapter passes a statement that may have changed one, it sets it to 0 and reads it again.
struct DriveRates {
    std::int64_t velocity = 0;      ///< of a positioning move, increments/s
    std::int64_t acceleration = 0;  ///< increments/s^2
    std::int64_t deceleration = 0;  ///< of a halt and of the end of a move, increments/s^2
    std::int64_t quick_stop = 0;    ///< of a quick stop, increments/s^2
    bool operator==(const DriveRates&) const = default;
};

/// How the motion in progress ends, as far as the drive reports it.
enum class Course : std::uint8_t {
    unknown,    ///< not reported
    to_target,  ///< it ends at a target
    endless     ///< it continues at a speed, or follows a stream, until another order
};

/// The present state of the axis in its drive: the part of the CiA 402 state that only the drive knows. An adapter sends the whole struct
/// each time a part of it was read; `at` is the instant of the newest part.
struct AxisFeedback {
    enum class Power : std::uint8_t { unknown, off, on };
    Power power = Power::unknown;
    bool moving = false;          ///< speed is not zero, or a motion is in progress
    bool target_reached = false;  ///< the last commanded motion ended at its target
    bool referenced = false;      ///< the position refers to a known zero
    bool fault = false;           ///< the drive is in an error that must be reset before it moves again
    bool warning = false;
    bool internal_limit = false;  ///< a limit (switch, software, torque) is active
    bool quick_stopping = false;  ///< the quick-stop ramp is active, or the drive is locked after it
    bool homing = false;          ///< a homing is in progress, also while the axis stands between its parts
    bool homing_attained = false;
    bool homing_error = false;
    std::int64_t position = 0;         ///< actual position, increments
    std::int64_t position_demand = 0;  ///< demand position at the instant of `position`, increments; drive and computed only
    DemandSource demand_source = DemandSource::none;
    std::int64_t velocity = 0;        ///< actual velocity, increments/s
    std::uint16_t error_code = 0;     ///< the drive's own, 0 = none
    std::uint32_t native_status = 0;  ///< the drive's own status word(s), described in its README
    /// The state of a drive that has the CiA 402 state machine itself, as bits 0..6 of a status word (0x27: operation enabled); absent: it
    /// knows only on and off. Other bits are ignored, because they have members of their own here.
    std::optional<std::uint16_t> statusword{};
    /// The axis is simulated by another gateway: a twin serves it there.
    bool simulated = false;
    /// An input that removes power or motion is active now (the family's page lists it under `safe_inputs`): STO, an external stop, an open
    /// enable input.
    bool safe_stop = false;
    Course course = Course::unknown;  ///< of the motion in progress; without meaning for an axis at rest
    DriveRates rates{};
    Instant at{};
};

/// How a drive reports by itself on a line with a SYNC: at each n-th SYNC.
struct DriveBeats {
    Duration beat{};  ///< time between two SYNCs while something moves; longer at rest
    int turns = 0;    ///< 0: it is polled instead
    bool operator==(const DriveBeats&) const = default;
};

/// Whether a drive answers. Sent at every change.
struct DriveLink {
    DriveId drive = no_drive;
    bool online = false;
    std::uint32_t silent_exchanges = 0;  ///< in succession
    Duration retry_pause{};              ///< present pause between attempts while it is silent
    std::string text;                    ///< the reason, for people
    DriveWatchdog watchdog{};
    DriveLimits limits{};
    DriveBeats beats{};
};

enum class Severity : std::uint8_t { info, warning, alarm };
[[nodiscard]] std::string_view name_of(Severity severity) noexcept;

/// An event that a drive causes: an alarm, a notification, a violation of the protocol.
struct Notice {
    Severity severity = Severity::info;
    DriveId drive = no_drive;
    AxisId axis = no_axis;
    std::string kind;       ///< a stable word: "alarm", "input", "protocol", "presence", "error_report"...
    std::int32_t code = 0;  ///< the drive's own code, 0 if none
    std::string text;
    Instant at{};
};

}  // namespace axisgate
