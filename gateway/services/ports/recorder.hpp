// Trends of axes, and recordings: the recent traffic of the gateway, written to files. Trends are returned at once; contents of the disk
// come by callbacks on the service thread. Bounds: trends and the recorded period by bytes of memory, recordings by bytes on the disk; a
// full memory is reported and stops nothing else.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/engine/flight_record.hpp"
#include "gateway/services/recorder/playback.hpp"
#include "gateway/services/recorder/trends.hpp"

namespace axisgate {

struct RecordingInfo {
    std::string name, why, who, version;
    std::int64_t at_unix_ns = 0;
    std::int64_t from_unix_ns = 0, to_unix_ns = 0;  ///< the period that it shows
    std::uint64_t bytes = 0;
    bool automatic = false;
    std::string not_replayable;  ///< the reason why not; empty: it can be replayed
    std::string fault;           ///< the reason why the file is not usable; then all members but name and bytes are empty
};

struct RecorderState {
    std::uint64_t lost = 0;              ///< records that found the hot thread's ring full, since the start
    std::uint64_t bytes = 0, bound = 0;  ///< memory of the period that can be written
    std::optional<Instant> from;         ///< its begin
    std::string not_replayable;          ///< as in RecordingInfo
    std::uint64_t trend_bytes = 0, trend_bound = 0;
    double trend_minutes = 0;
    std::uint64_t disk_bytes = 0, disk_bound = 0;
    std::string disk_fault;  ///< the reason why the last recording could not be written; empty: it could
};

struct RecordingFault {
    enum class Kind : std::uint8_t { none, no_such, exists, no_room, busy, damaged } kind = Kind::none;
    std::string text;
};

class RecorderPort {
public:
    virtual ~RecorderPort() = default;
    [[nodiscard]] virtual TrendStretch trend(AxisId axis, Instant from, Instant to, std::size_t columns) = 0;
    [[nodiscard]] virtual RecorderState recorder_state() = 0;
    [[nodiscard]] virtual std::vector<RecordingInfo> recordings() const = 0;  ///< newest first
    /// Writes the period up to now to a file.
    virtual void freeze(std::string name, std::string why, std::string who, std::function<void(RecordingFault, RecordingInfo)> then) = 0;
    /// Reads every record of the period from an instant on, in order, on a thread of the recorder; then calls `then` on the service thread.
    virtual void read_stretch(Instant from, std::function<void(const FlightRecord&)> each, std::function<void()> then) = 0;
    virtual void load_recording(const std::string& name, std::function<void(std::optional<std::string>)> then) = 0;
    /// The state that it shows at an instant, as a document (playback.hpp).
    virtual void play_back(const std::string& name, PlaybackWish wish, std::function<void(RecordingFault, boost::json::object)> then) = 0;
    virtual void rename_recording(const std::string& name, const std::string& to, std::function<void(RecordingFault)> then) = 0;
    virtual void remove_recording(const std::string& name, std::function<void(RecordingFault)> then) = 0;
};

}  // namespace axisgate
