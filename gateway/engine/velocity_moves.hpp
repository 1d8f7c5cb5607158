// Velocity moves: what ends a motion that has no end of its own: the hand that holds it lets go, or a limit of position is near.
// In: the dead-man time-out of a move, feedback, the passing of time. Out: halts, and events that say why.
// Never starts a motion.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class VelocityMoves {
public:
    VelocityMoves(Publisher& publisher, Orders& orders) : publisher_(publisher), orders_(orders) {}
    [[nodiscard]] bool hold_on(Axis& axis, const Command& command, Instant now);
    static void begin_hold(Axis& axis, const Move& move, const Origin& origin);
    void check_hold(Axis& axis, Instant now);
    void check_run(Axis& axis, Instant now);

private:
    Publisher& publisher_;
    Orders& orders_;
};

}  // namespace axisgate::engine
