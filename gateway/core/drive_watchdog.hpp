// The watchdog of a drive: its own reaction when it receives nothing from the gateway any more, as its adapter programmed it at the last
// setup and the drive acknowledged it.
#pragma once

#include <string>

#include "gateway/core/instant.hpp"

namespace axisgate {

struct DriveWatchdog {
    enum class State : std::uint8_t {
        unknown,  ///< the drive has not been set up yet, or its family has none
        off,      ///< the site has switched it off
        armed,    ///< programmed, and the drive has acknowledged it
        refused   ///< the drive does not accept it
    };
    State state = State::unknown;
    Duration time{};       ///< duration of the silence after which the drive acts
    std::string action{};  ///< "quick_stop", "disable", "fault"
    bool operator==(const DriveWatchdog&) const = default;
};

}  // namespace axisgate
