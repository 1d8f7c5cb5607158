// Assigns a number to the member of a write that belongs to a point of the standard map. A number that does not fit its width is refused
// and never wrapped.
#include "gateway/axis/process_data.hpp"

#include <utility>

namespace axisgate {
namespace {
template <class T>
bool take(std::optional<T>& into, std::int64_t n) {
    if (!std::in_range<T>(n)) return false;
    into = static_cast<T>(n);
    return true;
}
}  // namespace

bool put_process_data(ProcessData& d, AxisPoint point, std::int64_t n) {
    switch (point) {
        case AxisPoint::controlword:
            return take(d.controlword, n);
        case AxisPoint::mode:
            return take(d.mode, n);
        case AxisPoint::target_position:
            return take(d.target_position, n);
        case AxisPoint::profile_velocity:
            return take(d.profile_velocity, n);
        case AxisPoint::profile_acceleration:
            return take(d.profile_acceleration, n);
        case AxisPoint::profile_deceleration:
            return take(d.profile_deceleration, n);
        case AxisPoint::target_velocity:
            return take(d.target_velocity, n);
        case AxisPoint::homing_method:
            return take(d.homing_method, n);
        default:
            return false;
    }
}

}  // namespace axisgate
