// The software limits of position in a drive, as its adapter has programmed them from the site's limits and the drive has acknowledged
// them. Another client may have changed the drive since.
#pragma once

#include <cstdint>
#include <string>

namespace axisgate {

struct DriveLimits {
    enum class State : std::uint8_t {
        unknown,  ///< the drive has not been set up yet, its family has no such limits, or the site gives none
        off,      ///< the drive's option `drive_limits` has switched them off
        armed,    ///< programmed for each axis that the site limits, and acknowledged
        refused   ///< the drive does not accept them; `text` has the reason
    };
    State state = State::unknown;
    std::string text{};  ///< for people; empty unless refused
    bool operator==(const DriveLimits&) const = default;
};

}  // namespace axisgate
