// Reports on the condition of lines and drives, made by the engine for doors and metrics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/axis/image.hpp"
#include "gateway/core/adapter.hpp"
#include "gateway/core/line.hpp"

namespace axisgate {

struct DriveStatus {
    Presence presence = Presence::offline;  ///< the side that serves the axes now
    bool simulated = false;                 ///< the twin serves them, whether it answers or not
    bool device_online = false;             ///< the real drive answers
    std::string text;                       ///< the reason, for people
    std::uint32_t silent_exchanges = 0;
    std::int64_t retry_pause_ms = 0;
    DriveWatchdog watchdog{};  ///< of the serving drive
    DriveLimits limits{};      ///< the same
    DriveBeats beats{};        ///< the same
};
struct LineReport {
    LineStatus status;          ///< of the real line; of the twin bus if the URI is "twin"
    AdapterCounters counters;   ///< without those counted during scans
    AdapterCounters scanned;    ///< during scans: addresses without a drive cause time-outs, which do not indicate a fault of the line
    bool has_twin_bus = false;  ///< some of its drives are simulated now
    LineStatus twin_status;
    /// The counters of each family's adapter; `counters` is their sum.
    struct OfFamily {
        std::string family;
        AdapterCounters counters;
    };
    std::vector<OfFamily> families;
    std::uint64_t unclaimed = 0;  ///< CAN frames whose identifiers belong to no family of the line
};

}  // namespace axisgate
