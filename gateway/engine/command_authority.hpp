// Command authority: who may command an axis, what a lease does to the others, and what is said about it.
// In: commands with their origin. Out: refusals that name the holder, events of kind "authority", the image's holder and register 17.
// Never holds up a stop, and never asks the gateway's own orders.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class CommandAuthority {
public:
    CommandAuthority(Machine& machine, Publisher& publisher) : machine_(machine), publisher_(publisher) {}
    [[nodiscard]] AxisAuthority::Verdict may_command(const Axis& axis, const Command& command, Instant now) const;
    /// Ends motion and nothing else: not asked for a lease.
    [[nodiscard]] static bool only_stops(const Axis& axis, const CommandBody& body);
    /// Nothing: the client is noted as the one who commands; else another client holds the axis, by its name.
    [[nodiscard]] std::optional<Refusal> ask(Axis& axis, const Command& command, Instant now);
    void note_commander(Axis& axis, const Origin& origin, Instant now);
    void hold(Axis& axis, const Command& command, const HoldAxis& wish, Instant now);
    void changed(Axis& axis, const AxisAuthority::Verdict& verdict, const Origin* by, Instant now);

private:
    Machine& machine_;
    Publisher& publisher_;
};

}  // namespace axisgate::engine
