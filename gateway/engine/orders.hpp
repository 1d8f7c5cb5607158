// Orders: commands of the engine to adapters, and what has become of them.
// In: what a client's command, a fault reaction or a loss of command comes to; results of adapters, acknowledgements of the store. Out: the
// order at its adapter; the client's answer, the axis' profile and picture, store orders.
// Never gives an order of the engine's own that the site's limits forbid.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Orders {
public:
    Orders(Machine& machine, Pending& pending, EngineHost& host, Publisher& publisher, Routing& routing, Twins& twins, Presences& presences,
           Clients& clients, VelocityMoves& velocity_moves, Streams& streams)
        : machine_(machine),
          pending_(pending),
          host_(host),
          publisher_(publisher),
          routing_(routing),
          twins_(twins),
          presences_(presences),
          clients_(clients),
          velocity_moves_(velocity_moves),
          streams_(streams) {}
    /// Sends one order to the adapter of the axis' line. `client`: whose command it is; null for the engine's own.
    void give(Axis& axis, Client* client, CommandBody body, Origin origin, Instant now);
    /// A command of the engine's own: what the axis' state makes of it.
    void give_own(Axis& axis, const CommandBody& body, Instant now);
    void result(const Result& result, Instant now);
    /// The ticket of the client for whom it was given; no_ticket: nobody's, or it has ended.
    [[nodiscard]] Ticket client_of(Ticket order) const noexcept;
    void on_stored(Ticket order, const std::string& fault, Instant now);
    [[nodiscard]] std::optional<Refusal> beyond_limits(const Axis& axis, const CommandBody& body) const;

private:
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
    VelocityMoves& velocity_moves_;
    Streams& streams_;
};

}  // namespace axisgate::engine
