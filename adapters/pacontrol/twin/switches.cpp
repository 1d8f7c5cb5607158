// Where the switches of an axis are: at the ends of travel, or once a turn of a rotary axis.
// In: places of the shaft. Out: actuated or not, instants. Never steps: the next switch has its closed-form instant.
#include "adapters/pacontrol/twin/switches.hpp"

#include <cmath>

namespace axisgate::pacontrol::twin {
namespace {
constexpr double edge_slack = 1e-9;  // of a turn: a rotary axis that stands on the edge is off its switch
}

bool Switches::limit(bool positive) const noexcept {
    const bool exchanged = p_[ap::limits_exchanged] != 0;
    const bool at_positive = positive != exchanged;
    return limit_by_hand(at_positive) || at_shaft(at_positive);
}

bool Switches::at_shaft(bool positive) const noexcept {
    const double at = shaft_.place();
    if (model_.revolution <= 0) {
        const double beyond = (positive ? at - model_.travel_max : model_.travel_min - at) + 1e-6;
        return closed(beyond, positive ? was_positive_ : was_negative_);
    }
    const double turn = at / model_.revolution;
    const double part = turn - std::floor(turn);
    return part >= 1 - switch_share - 1e-9 && part < 1 - 1e-9;
}

bool Switches::home() const noexcept {
    if (home_) return true;
    if (model_.revolution > 0) return at_shaft(false);
    const double at = shaft_.rest_place();
    return at < 0 || (was_home_ && at < model_.hysteresis);
}

void Switches::follow() noexcept {
    if (model_.hysteresis <= 0 || model_.revolution > 0) return;
    was_positive_ = at_shaft(true);
    was_negative_ = at_shaft(false);
    const double at = shaft_.place();
    was_home_ = at < 0 || (was_home_ && at < model_.hysteresis);
}

/// At shaft position 0; of a rotary axis the whole turn at or below, where its switch is the reference switch first of all [L834]; on the
/// switch the whole turn above.
double Switches::edge_below(double place) const noexcept {
    if (model_.revolution <= 0) return 0;
    return (std::floor(place / model_.revolution + edge_slack) + (at_shaft(false) ? 1 : 0)) * model_.revolution;
}

Instant Switches::passed() const noexcept {
    const bool up = shaft_.path().direction() > 0;
    const double offset = shaft_.offset();
    if (model_.revolution <= 0) {
        const double end = up ? model_.travel_max : model_.travel_min;
        return at_shaft(up) ? never : shaft_.path().when(end + offset);
    }
    const double turn = shaft_.place() / model_.revolution;
    double next = std::floor(turn + edge_slack) + (up ? 1 - switch_share : 0);
    if (up && turn >= next) next += 1;  // it began on the switch
    return shaft_.path().when(next * model_.revolution + offset);
}

}  // namespace axisgate::pacontrol::twin
