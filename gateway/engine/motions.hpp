// Motions keeps the one record of motion of each axis. A record begins with the drive's acknowledgement, or with movement that no order
// explains, and ends with a standstill that the drive reports. No refusal, question, setting or command of another client changes it in
// between, so its guards cannot be bypassed.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Motions {
public:
    Motions(Publisher& publisher, Orders& orders, Clients& clients, Streams& streams, LossOfCommand& loss)
        : publisher_(publisher), orders_(orders), clients_(clients), streams_(streams), loss_(loss) {}

    /// The record that an order will make when the drive has accepted it; empty if the order moves nothing.
    [[nodiscard]] static std::optional<Motion> asked(const Axis& axis, const CommandBody& body, const Origin& origin);
    /// The drive has accepted an order: earlier motions that are being watched are over, and the guards of this motion apply. `by` is the
    /// number of the client's command; 0 for an order of the engine itself.
    void acknowledged(Axis& axis, Motion motion, MotionOrder order, std::uint64_t by, std::string_view what, Instant now);
    void stop_acknowledged(Axis& axis, Stops::Kind kind, Instant now);
    /// An order was sent, and it is unknown whether the drive accepted it.
    void suspect(Axis& axis, Motion motion);
    /// Feedback of the axis: a standstill ends the record, movement without a record begins one.
    void look(Axis& axis, Instant now);
    /// Another drive, channel or twin serves the axis now.
    void forget(Axis& axis);

    /// The same velocity move is requested again while it is held: it continues, and nothing is sent. True if the command was answered by
    /// this.
    [[nodiscard]] bool hold_on(Axis& axis, const Command& command, Instant now);
    /// Called with every housekeeping: checks the dead-man times, and repeats stops whose answer was lost.
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
