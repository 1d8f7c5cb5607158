// Clients keeps each command from its arrival until its one answer. The end of a motion is watched until the motion is done, interrupted or
// lost. Silence is never taken for success: a command whose end nobody observed is reported as failed or is watched further.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Clients {
public:
    Clients(Machine& machine, Pending& pending, Publisher& publisher) : machine_(machine), pending_(pending), publisher_(publisher) {}
    void track(Axis& axis, Instant now);
    void supersede(Axis& axis, std::uint64_t by, std::string_view what);
    void finish(std::uint64_t number, Result result);

private:
    Machine& machine_;
    Pending& pending_;
    Publisher& publisher_;
};

/// Limit of commands of one axis that are in progress at the same time; further ones are refused with `busy`.
inline constexpr std::size_t max_clients_per_axis = 64;

}  // namespace axisgate::engine
