// Reports: how a line and a drive are doing, as the engine tells it to whoever asks.
// In: made by the engine. Out: doors and metrics. Never a part of the round.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/axis/image.hpp"
#include "gateway/core/adapter.hpp"
#include "gateway/core/line.hpp"

namespace axisgate {

struct DriveStatus {
    Presence presence = Presence::offline;  ///< who serves the axes now
    bool simulated = false;                 ///< the twin serves them, whether it answers or not
    bool device_online = false;             ///< the real drive answers
    std::string text;                       ///< why it is so, for people
    std::uint32_t silent_exchanges = 0;
    std::int64_t retry_pause_ms = 0;
    DriveWatchdog watchdog{};  ///< of the drive that serves
    DriveLimits limits{};      ///< the same
    DriveBeats beats{};        ///< the same
};
struct LineReport {
    LineStatus status;          ///< of the real line; of the twin bus if the URI is "twin"
    AdapterCounters counters;   ///< without what was counted while a scan ran
    AdapterCounters scanned;    ///< while a scan ran: addresses where nobody is time out, which says nothing of the line
    bool has_twin_bus = false;  ///< some drives of it are simulated now
    LineStatus twin_status;
    /// What each family's adapter counted; `counters` is their sum.
    struct OfFamily {
        std::string family;
        AdapterCounters counters;
    };
    std::vector<OfFamily> families;
    std::uint64_t unclaimed = 0;  ///< CAN frames with identifiers that are no family's of the line
};

}  // namespace axisgate
