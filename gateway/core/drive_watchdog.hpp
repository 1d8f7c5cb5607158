// Drive watchdog: what a drive does by itself when it hears nothing of the gateway any more, as its adapter has programmed it.
// In: what the drive has acknowledged. Out: values for people and for the rehearsal's reader. Never a promise: it is what was set when the
// drive was set up last.
#pragma once

#include <string>

#include "gateway/core/instant.hpp"

namespace axisgate {

struct DriveWatchdog {
    enum class State : std::uint8_t {
        unknown,  ///< the drive has not been set up yet, or its family has none
        off,      ///< the site has switched it off
        armed,    ///< programmed, and the drive has acknowledged it
        refused   ///< the drive does not take it
    };
    State state = State::unknown;
    Duration time{};       ///< of silence, after which the drive acts
    std::string action{};  ///< "quick_stop", "disable", "fault"
    bool operator==(const DriveWatchdog&) const = default;
};

}  // namespace axisgate
