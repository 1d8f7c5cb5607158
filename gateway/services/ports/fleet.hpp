// Fleet port: the gateways of the domain and their axes, as they tell them, and the way of commands to axes of others.
// In: commands by gateway and axis. Out: what is known at once; exactly one result per command, by a callback on the service thread.
// Bounded: so many gateways and axes are kept, so many commands wait; what is more is left out, or answered "busy".
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gateway/services/command_wish.hpp"

namespace axisgate {

/// An axis as its gateway told it last; positions in increments.
struct FleetAxis {
    std::string name, family, unit, authority, holder;
    std::uint16_t number = 0;
    double increments_per_unit = 1;
    bool online = false, simulated = false, stale = false, referenced = false, moving = false, target_reached = false, fault = false,
         warning = false;
    std::uint16_t statusword = 0, error_code = 0, fail_safe_cause = 0;
    std::int16_t mode = 0;
    std::int64_t position = 0, position_demand = 0, velocity = 0;
    std::string demand_source;    ///< as name_of(DemandSource); empty: an older program, that does not say
    std::uint64_t sequence = 0;   ///< counts up with each state of its gateway; 0: an older program
    std::uint64_t answered = 0;   ///< states up to this one were told before the newest answer to a command from here
    std::int64_t at_unix_ns = 0;  ///< on its gateway's clock; 0: its drive was never seen
    std::int64_t age_ms = -1;     ///< since then, the clocks' difference taken out, delivery included; -1: its drive was never seen
};

struct FleetGateway {
    std::string name;
    std::uint64_t instance = 0;  ///< another one at each start
    bool here = false;           ///< this gateway itself
    bool alive = true;           ///< false: it has ended, or was not heard within its lease
    bool namesake = false;       ///< another one that is alive has the same name
    std::string version, http;
    std::int64_t at_unix_ns = 0;      ///< on its own clock
    std::int64_t clock_ahead_ns = 0;  ///< its clock against this machine's when its state came, delivery included
    std::uint64_t uptime_ms = 0;
    std::int64_t silent_ms = 0;   ///< since its last word came here
    std::vector<FleetAxis> axes;  ///< by name
};

/// A command to an axis of the domain, in the unit of that axis: it may not be known yet.
struct FleetOrder {
    std::string gateway, axis;
    std::uint64_t instance = 0;  ///< 0: whichever is alive, if there is one alone
    CommandWish wish;
    bool until_done = false;
    Origin origin;
    Duration wait{};  ///< no longer is its result waited for, nor the command sent again; 0: as long as a gateway remembers commands
};

class FleetPort {
public:
    virtual ~FleetPort() = default;
    /// By name, this gateway included; those that were lost within the last ten minutes are there as not alive.
    [[nodiscard]] virtual std::vector<FleetGateway> fleet() const = 0;
    virtual void command(FleetOrder order, std::function<void(const Result&)> then) = 0;
};

}  // namespace axisgate
