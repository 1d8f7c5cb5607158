// Fast captures of axes: started, observed, stored as files, read. Documents are returned at once or by callbacks on the service thread.
// Bounds: one capture of a line at a time, `most_running` in all; stored ones by number and bytes on the disk.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/services/ports/recorder.hpp"
#include "gateway/services/recorder/capture_document.hpp"

namespace axisgate {

struct CaptureInfo {
    std::string name;
    std::int64_t at_unix_ns = 0;
    std::uint64_t bytes = 0;      ///< on the disk; 0: not there (yet)
    std::string fault;            ///< the reason why its file is not usable
    boost::json::object summary;  ///< capture_summary
};

struct CaptureRoom {
    std::uint64_t bytes = 0, bound = 0;  ///< on the disk
    std::string disk_fault;              ///< the reason why the last one could not be written; empty: it could
};

class CapturePort {
public:
    static constexpr std::size_t most_running = 4;
    virtual ~CapturePort() = default;
    [[nodiscard]] virtual CaptureRoom capture_room() const = 0;
    [[nodiscard]] virtual std::vector<CaptureInfo> captures() = 0;  ///< running ones first, then newest first
    virtual void arm(CaptureOrder order, std::function<void(RecordingFault, CaptureInfo)> then) = 0;
    /// Its columns (capture_columns), as far as they exist; empty if the name does not exist, or if the fault gives another reason.
    virtual void load_capture(const std::string& name, std::function<void(RecordingFault, boost::json::array)> then) = 0;
    virtual void rename_capture(const std::string& name, const std::string& to, std::function<void(RecordingFault)> then) = 0;
    /// A running one is cancelled.
    virtual void remove_capture(const std::string& name, std::function<void(RecordingFault)> then) = 0;
};

}  // namespace axisgate
