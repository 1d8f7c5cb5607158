// The gateways of the DDS domain and their axes, as they report them, and the way of commands to axes of others. Each command gets exactly
// one result, by a callback on the service thread. Bounded: further gateways and axes are left out, and further commands are answered
// "busy".
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gateway/services/command_wish.hpp"

namespace axisgate {

/// The last report of an axis by its gateway; positions in increments.
struct FleetAxis {
    std::string name, family, unit, authority, holder;
    std::uint16_t number = 0;
    double increments_per_unit = 1;
    bool online = false, simulated = false, stale = false, referenced = false, moving = false, target_reached = false, fault = false,
         warning = false;
    std::uint16_t statusword = 0, error_code = 0, fail_safe_cause = 0;
    std::int16_t mode = 0;
    std::int64_t position = 0, position_demand = 0, velocity = 0;
    std::string demand_source;    ///< as in name_of(DemandSource); empty: an older program without this value
    std::uint64_t sequence = 0;   ///< increases with each state of its gateway; 0: an older program
    std::uint64_t answered = 0;   ///< states up to this number were sent before the newest answer to a command from here
    std::int64_t at_unix_ns = 0;  ///< on its gateway's clock; 0: its drive has not reported yet
    std::int64_t age_ms = -1;     ///< since then, without the difference of the clocks, including the delivery time; -1: its drive has not
                                  ///< reported yet
};

struct FleetGateway {
    std::string name;
    std::uint64_t instance = 0;  ///< differs at each start
    bool here = false;           ///< this gateway itself
    bool alive = true;           ///< false: it has ended, or sent nothing within its lease
    bool namesake = false;       ///< another running gateway has the same name
    std::string version, http;
    std::int64_t at_unix_ns = 0;      ///< on its own clock
    std::int64_t clock_ahead_ns = 0;  ///< its clock against that of this machine when its state arrived, including the delivery time
    std::uint64_t uptime_ms = 0;
    std::int64_t silent_ms = 0;   ///< since its last message
    std::vector<FleetAxis> axes;  ///< by name
};

/// A command to an axis of the domain, in the unit of that axis, which may be unknown yet.
struct FleetOrder {
    std::string gateway, axis;
    std::uint64_t instance = 0;  ///< 0: the running gateway of this name, if there is only one
    CommandWish wish;
    bool until_done = false;
    Origin origin;
    Duration wait{};  ///< how long the result is awaited and the command repeated; 0: as long as a gateway remembers commands
};

class FleetPort {
public:
    virtual ~FleetPort() = default;
    /// By name, this gateway included; gateways that were lost within the last ten minutes are listed as not alive.
    [[nodiscard]] virtual std::vector<FleetGateway> fleet() const = 0;
    virtual void command(FleetOrder order, std::function<void(const Result&)> then) = 0;
};

}  // namespace axisgate
