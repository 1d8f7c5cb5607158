// Supervisor: each axis' position, speed and state against the site's limits, at every feedback, whatever moves it.
// Limits that are looked at with an order see what the order names. A torque, a program, a statement nobody can read or a motion found at
// the start names nothing: what such a motion does is seen here alone, and ended here.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Supervisor {
public:
    Supervisor(Publisher& publisher, Orders& orders) : publisher_(publisher), orders_(orders) {}
    void look(Axis& axis, Instant now);

private:
    /// How far the axis may still go, and how it is ended: by a quick stop with an alarm, or before that by a halt that comes to rest at
    /// the limit.
    void limits(Axis& axis, const Motion& motion, Instant now);
    void speed(Axis& axis, Instant now);
    void state(Axis& axis, Instant now);
    void inputs(Axis& axis, Instant now);
    void halt(Axis& axis, bool up, std::int64_t limit, Instant now);
    void stop(Axis& axis, std::string_view kind, std::string_view why, Instant now);

    Publisher& publisher_;
    Orders& orders_;
};

}  // namespace axisgate::engine
