// The switches on the way of a simulated axis, operated by the shaft: limit switches at both ends and the cam of the home switch. A switch
// with hysteresis is released this many increments behind the place where it was operated.
#pragma once

#include <cmath>

#include "adapters/cia402/twin/homing.hpp"

namespace axisgate::cia402_drive::twin {

class Switches {
public:
    double hysteresis = 0;  ///< increments
    /// The shaft is at `place`. `travel`: half the distance between the limit switches; 0: there are no switches.
    void look(double place, double travel) noexcept {
        if (travel <= 0) return;
        take(low_, -travel - place);
        take(high_, place - travel);
        take(home_, cam - std::fabs(place));
    }
    [[nodiscard]] bool low() const noexcept { return low_; }
    [[nodiscard]] bool high() const noexcept { return high_; }
    [[nodiscard]] bool home() const noexcept { return home_; }

private:
    void take(bool& on, double inside) const noexcept { on = inside > 0 || (on && inside > -hysteresis); }
    bool low_ = false, high_ = false, home_ = false;
};

}  // namespace axisgate::cia402_drive::twin
