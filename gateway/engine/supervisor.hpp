// Supervisor compares the position, speed and state of each axis with the site's limits, at every feedback and for every kind of motion.
// Checks of an order see only the values that the order names. A torque, a program, an unreadable statement or a motion that was found at
// the start names none: only the supervisor sees such a motion and can end it.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Supervisor {
public:
    Supervisor(Publisher& publisher, Orders& orders) : publisher_(publisher), orders_(orders) {}
    void look(Axis& axis, Instant now);

private:
    /// Checks how far the axis may still go, and ends the motion: by a quick stop with an alarm, or earlier by a halt that comes to rest at
    /// the limit.
    void limits(Axis& axis, const Motion& motion, Instant now);
    void speed(Axis& axis, Instant now);
    void state(Axis& axis, Instant now);
    void halted(Axis& axis, Instant now);
    void inputs(Axis& axis, Instant now);
    void halt(Axis& axis, bool up, std::int64_t limit, Instant now);
    void stop(Axis& axis, std::string_view kind, std::string_view why, Instant now);

    Publisher& publisher_;
    Orders& orders_;
};

}  // namespace axisgate::engine
