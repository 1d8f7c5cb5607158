// The words for a line's states, as they appear in REST answers and metrics. They are part of the contract: never translated, never
// changed.
#include "gateway/core/line.hpp"

#include <string_view>

namespace axisgate {

std::string_view name_of(LineStatus::State state) noexcept {
    switch (state) {
        case LineStatus::State::closed:
            return "closed";
        case LineStatus::State::opening:
            return "opening";
        case LineStatus::State::up:
            return "up";
        case LineStatus::State::down:
            return "down";
        case LineStatus::State::bus_off:
            return "bus_off";
    }
    return "closed";
}

}  // namespace axisgate
