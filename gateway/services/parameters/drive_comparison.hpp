// A drive and its twin, value by value, and the reply times of the drive against the range of its specimen. The values of the drive come
// from a sweep, those of the twin from a gateway in virtual time; the reply times come from the recorded frames of the line. Nothing is
// sent from here. compare_drive takes up to some seconds of processor time, so it must not run on the hot or the service thread.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/engine/comparison.hpp"
#include "gateway/services/parameters/drive_sweep.hpp"
#include "gateway/services/parameters/twin_values.hpp"

namespace axisgate {

struct DriveComparisonInput {
    TwinPlace place;
    NonVolatile memory;  ///< of the twin; empty: factory state
    SweepPlan plan;
    Sweep sweep;
    std::string identity;           ///< as the drive's link tells it
    std::vector<SeenFrame> frames;  ///< of its line during the sweep; `at` since the first one
    Duration tolerance = std::chrono::milliseconds(20);
};

struct ComparedValue {
    enum class Kind : std::uint8_t {
        value,     ///< drive and twin hold different values
        changed,   ///< the drive gave two values when it was asked twice
        measured,  ///< it differs, and follows from motion, temperature, supply or the program: not counted as a difference
        missing,   ///< the drive refuses it, and its twin has it
        extra      ///< the drive has it, and its twin refuses it
    };
    Kind kind = Kind::value;
    std::string id, name, unit;
    Value drive, again, twin;  ///< unknown: this side has none; `again`: the second reading, of `changed` only
    std::string text{};        ///< the reason of the side that refuses
};
[[nodiscard]] std::string_view name_of(ComparedValue::Kind kind) noexcept;

struct DriveComparison {
    std::string fault;  ///< the comparison is not complete, and why; empty: it is
    std::string family, drive, axis, address, identity, specimen;
    std::size_t read = 0, equal = 0;
    std::vector<ComparedValue> rows;   ///< that differ, in the order of the catalogue
    std::vector<JobFailure> left_out;  ///< that were not asked for, and why
    std::vector<JobFailure> neither;   ///< that both refuse; the reason of the drive
    struct Replies {
        std::string fault;  ///< why the reply times could not be compared; empty: they could
        Duration shortest{}, median{}, longest{};
        std::vector<Difference> outside;  ///< late and early answers
    } replies;
    Adoption adoption;  ///< how the twin becomes this drive
    /// Differences that count: all but `measured`.
    [[nodiscard]] std::size_t differences() const noexcept;
};

/// The trace of a line as frames of a recording that begins with its first one.
[[nodiscard]] std::vector<SeenFrame> seen_frames(const std::vector<TraceEntry>& trace);
[[nodiscard]] DriveComparison compare_drive(const DriveComparisonInput& input);
[[nodiscard]] boost::json::object document_of(const DriveComparison& comparison);

}  // namespace axisgate
