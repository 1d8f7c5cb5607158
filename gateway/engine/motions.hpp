// Motions: the life of an axis' one record of motion.
// A record begins with the drive's acknowledgement, or with movement that nobody ordered, and ends with standstill that the drive reports.
// Between the two no refusal, question, setting or word of another client touches it, so that whatever guards it cannot be talked away.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Motions {
public:
    Motions(Publisher& publisher, Orders& orders, Clients& clients, Streams& streams, LossOfCommand& loss)
        : publisher_(publisher), orders_(orders), clients_(clients), streams_(streams), loss_(loss) {}

    /// The record that an order makes once the drive has taken it; nothing: it moves nothing by itself.
    [[nodiscard]] static std::optional<Motion> asked(const Axis& axis, const CommandBody& body, const Origin& origin);
    /// The drive has taken an order: what somebody else still watched is over, and guards are this motion's from now on.
    /// `by`: the number of the client whose order it is; 0: the engine's own.
    void acknowledged(Axis& axis, Motion motion, MotionOrder order, std::uint64_t by, std::string_view what, Instant now);
    void stop_acknowledged(Axis& axis, Stops::Kind kind, Instant now);
    /// An order left, and nobody knows whether it was taken.
    void suspect(Axis& axis, Motion motion);
    /// What the drive says of the axis: standstill ends the record, movement without one begins one.
    void look(Axis& axis, Instant now);
    /// Another drive, channel or twin speaks for the axis.
    void forget(Axis& axis);

    /// The same velocity move again while it is held: it goes on, and nothing is sent. True: the command has its answer.
    [[nodiscard]] bool hold_on(Axis& axis, const Command& command, Instant now);
    /// With every housekeeping: the dead-man time-out, and stops whose answer was lost.
    void check(Axis& axis, Instant now);

private:
    void rests(Axis& axis, Instant now);
    void moves_without_record(Axis& axis, Instant now);

    Publisher& publisher_;
    Orders& orders_;
    Clients& clients_;
    Streams& streams_;
    LossOfCommand& loss_;
};

}  // namespace axisgate::engine
