// A protocol server on the service thread. Commands go through the axis port with the door's name as origin; each gets its one result
// through the function that was passed with it. Doors on the hot thread implement HotDoor instead.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "gateway/site/ways_in.hpp"

namespace axisgate {

class ServiceDoor {
public:
    virtual ~ServiceDoor() = default;
    /// Name in the log and in `ready`, such as "http".
    [[nodiscard]] virtual std::string_view name() const = 0;
    /// The ways in which a client can set an axis in motion over this door, each with the causes of loss that end such a motion. Empty if
    /// the door only shows values.
    [[nodiscard]] virtual std::span<const WayIn> ways_in() const = 0;
    /// Opens the door. Empty if it is open; otherwise the fault and the remedy.
    [[nodiscard]] virtual std::string start() = 0;
    /// The address at which it is open; empty while it is closed.
    [[nodiscard]] virtual std::string address() const = 0;
    /// Accepts no new clients, lets running work end within its bound, then calls `done`, but not from inside this call.
    virtual void stop(std::function<void()> done) = 0;
};

}  // namespace axisgate
