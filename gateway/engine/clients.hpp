// Clients: commands on their way until their one answer; motions are watched until they are done, interrupted or lost.
// In: the profiles' feedback, motions that take the place of others. Out: the one result of each command.
// Never takes silence for success: what nobody saw end is reported as failed or goes on being watched.
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

/// Commands of one axis that may be on their way at the same time; beyond it: busy.
inline constexpr std::size_t max_clients_per_axis = 64;

}  // namespace axisgate::engine
