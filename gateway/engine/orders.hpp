// Orders sends the engine's orders to the adapters and applies their results. Orders come from clients' commands, fault reactions and
// losses of command; their results go to the client's answer, the profile and the picture of the axis, and the store. Equal stops of an
// axis share one entry, so that many of them cannot keep another stop out.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Orders {
public:
    Orders(Machine& machine, Pending& pending, EngineHost& host, Publisher& publisher, Routing& routing, Twins& twins, Presences& presences,
           Clients& clients, Motions& motions, Streams& streams, LossOfCommand& loss)
        : machine_(machine),
          pending_(pending),
          host_(host),
          publisher_(publisher),
          routing_(routing),
          twins_(twins),
          presences_(presences),
          clients_(clients),
          motions_(motions),
          streams_(streams),
          loss_(loss) {}
    /// Sends one order to the adapter of the axis' line. `client` is the command that it belongs to; null for the engine's own orders.
    void give(Axis& axis, Client* client, CommandBody body, Origin origin, Instant now);
    /// Carries out a command of the engine itself, as the state of the axis requires.
    void give_own(Axis& axis, const CommandBody& body, Instant now);
    /// Sends the stop that is wanted and was not acknowledged once more.
    void stop_again(Axis& axis, Instant now);
    /// `what` was given before a stop, and the drive accepted it behind the stop: reports this, and stops the axis again.
    void stop_behind(Axis& axis, std::string_view what, const Origin& by, Instant now);
    void result(const Result& result, Instant now);
    /// The motion that a native statement, an action or a parameter write requests, as its family reads it; `nothing` for other bodies.
    [[nodiscard]] static Stated stated(const Axis& axis, const CommandBody& body);
    /// The ticket of the client for which it was given; no_ticket if there is none, or if it has ended.
    [[nodiscard]] Ticket client_of(Ticket order) const noexcept;
    void on_stored(Ticket order, const std::string& fault, Instant now);
    [[nodiscard]] std::optional<Refusal> beyond_limits(const Axis& axis, const CommandBody& body) const;
    [[nodiscard]] Axis& concerned(const Axis& axis, const Stated& said) const;

private:
    [[nodiscard]] std::optional<Refusal> beyond_by_statement(const Axis& axis, const Stated& said) const;
    [[nodiscard]] bool join_stop(Axis& axis, Client* client, const CommandBody& body);
    void begin_stop(Axis& axis, const OrderRecord& record, Ticket ticket, Instant now);
    void send(Axis& axis, Client* client, Ticket ticket, CommandBody body, Origin origin, Instant now);
    void store_write(Axis& axis, OrderRecord& record, Result& result, Ticket ticket, Instant now);
    void motion_taken(Axis& axis, Motion motion, const OrderRecord& record, Ticket order, Instant now);
    void record_motion(Axis& axis, OrderRecord& record, Ticket mover, const Result& result, Instant now);
    void answer(std::uint64_t client, Axis& axis, const Result& result, Instant now);
    void not_carried_out(const Axis& axis, const CommandBody& body, const Result& result, Instant now);
    void remember_ramp(Axis& axis, const CommandBody& body);
    void remember_prepared(Axis& axis, const CommandBody& body);

    Machine& machine_;
    Pending& pending_;
    EngineHost& host_;
    Publisher& publisher_;
    Routing& routing_;
    Twins& twins_;
    Presences& presences_;
    Clients& clients_;
    Motions& motions_;
    Streams& streams_;
    LossOfCommand& loss_;
};

}  // namespace axisgate::engine
