// CommandAuthority decides whether a client may command an axis, and reports changes of the lease: refusals name the holder, events have
// the kind "authority", and the image shows the holder and register 17. Stops are never checked, and neither are the gateway's own orders.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class CommandAuthority {
public:
    CommandAuthority(Machine& machine, Publisher& publisher) : machine_(machine), publisher_(publisher) {}
    [[nodiscard]] AxisAuthority::Verdict may_command(const Axis& axis, const Command& command, Instant now) const;
    /// True if the command only ends motion; such a command needs no lease.
    [[nodiscard]] static bool only_stops(const Axis& axis, const CommandBody& body);
    /// Empty if the client may command (it is then recorded as the commander); otherwise the refusal, which names the client that holds the
    /// axis.
    [[nodiscard]] std::optional<Refusal> ask(Axis& axis, const Command& command, Instant now);
    void note_commander(Axis& axis, const Origin& origin, Instant now);
    void hold(Axis& axis, const Command& command, const HoldAxis& wish, Instant now);
    void changed(Axis& axis, const AxisAuthority::Verdict& verdict, const Origin* by, Instant now);

private:
    Machine& machine_;
    Publisher& publisher_;
};

}  // namespace axisgate::engine
