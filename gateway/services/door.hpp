// Service door: a protocol server on the service thread, one among several.
// In: what the gateway and the services tell. Out: an open door at an address. Commands go through the axis port, with the door's name as
// origin; each gets its one result by the function that was given along.
// Never used on the hot thread: doors there are HotDoor.
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
    /// As the log and `ready` call it: "http".
    [[nodiscard]] virtual std::string_view name() const = 0;
    /// By which somebody can set an axis in motion here, each with the losses that end it; none: it only shows.
    [[nodiscard]] virtual std::span<const WayIn> ways_in() const = 0;
    /// Opens it. Empty: it is open; else what is wrong and what to do.
    [[nodiscard]] virtual std::string start() = 0;
    /// Where it is open; empty while it is closed.
    [[nodiscard]] virtual std::string address() const = 0;
    /// Takes nobody more in, lets what is under way end within its bound, then calls `done`, not from inside this call.
    virtual void stop(std::function<void()> done) = 0;
};

}  // namespace axisgate
