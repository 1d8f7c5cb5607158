// Line names: the words for a line's states, as they appear in REST answers and metrics.
// In: enumerators. Out: words. Never translated, never changed: they are the contract.
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
