// Reports, recorded frames and scans of lines, and the ports of this machine. Reports are returned at once; answers of the hot thread come
// by callbacks on the service thread. Bounded: older frames of a record are overwritten and counted as missed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/core/line.hpp"
#include "gateway/core/scan.hpp"
#include "gateway/core/system_port.hpp"
#include "gateway/engine/report.hpp"

namespace axisgate {

/// Frames of a line, in their order.
struct Trace {
    std::vector<TraceEntry> entries;
    std::uint64_t missed = 0;  ///< requested, but already overwritten
    std::uint64_t next = 0;    ///< `since` for the next call
};

class LinePort {
public:
    virtual ~LinePort() = default;
    [[nodiscard]] virtual LineReport line_report(LineId line) const = 0;  ///< at most 200 ms old
    /// Frames with sequence >= since, at most `limit`.
    [[nodiscard]] virtual Trace trace(LineId line, std::uint64_t since, std::size_t limit) const = 0;
    /// Starts a search for drives on a line; empty if it has begun, otherwise the reason why not.
    virtual void start_scan(LineId line, ScanWish wish, Origin origin, std::function<void(std::string)> then) = 0;
    virtual void cancel_scan(LineId line, std::function<void(ScanReport)> then) = 0;
    virtual void scan_report(LineId line, std::function<void(ScanReport)> then) = 0;
    [[nodiscard]] virtual std::vector<SystemPort> host_ports() const = 0;  ///< as the system lists them now
};

}  // namespace axisgate
