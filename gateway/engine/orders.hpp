// Orders: commands of the engine to adapters, and what has become of them.
// In: what a client's command, a fault reaction or a loss of command comes to; results of adapters, acknowledgements of the store. Out: the
// order at its adapter; the client's answer, the axis' profile and picture, store orders.
// Equal stops of an axis share one place on their way down, so that no crowd of them keeps another stop out.
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
    /// Sends one order to the adapter of the axis' line. `client`: whose command it is; null for the engine's own.
    void give(Axis& axis, Client* client, CommandBody body, Origin origin, Instant now);
    /// A command of the engine's own: what the axis' state makes of it.
    void give_own(Axis& axis, const CommandBody& body, Instant now);
    /// The stop that is wanted and was not acknowledged, once more.
    void stop_again(Axis& axis, Instant now);
    /// `what` was given before a stop, and the drive took it behind that: it is told, and stopped again.
    void motion_taken(Axis& axis, Motion motion, const OrderRecord& record, Ticket order, Instant now);
    void stop_behind(Axis& axis, std::string_view what, const Origin& by, Instant now);
    void result(const Result& result, Instant now);
    /// What a native statement, an action or a parameter write asks of the axis, as its family reads it; other bodies are `nothing`.
    [[nodiscard]] static Stated stated(const Axis& axis, const CommandBody& body);
    /// The ticket of the client for whom it was given; no_ticket: nobody's, or it has ended.
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
