// Publisher delivers everything that leaves the engine: pictures into the image; results, events and samples to the host; all of them to
// the tap as well, if there is one. It takes no decisions.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Publisher {
public:
    Publisher(Machine& machine, EngineHost& host) : machine_(machine), host_(host) {}
    /// Null if nothing is recorded.
    void set_tap(FlightTap* tap) noexcept { tap_ = tap; }
    [[nodiscard]] FlightTap* tap() const noexcept { return tap_; }
    void publish(Axis& axis, Instant now);
    void event(Event e, Instant now);
    void answer(const Result& result);
    void refuse(const Command& command, Reason reason, std::string text);
    void sample(const Sample& sample, Instant now);
    void new_source(Axis& axis);

private:
    Machine& machine_;
    EngineHost& host_;
    FlightTap* tap_ = nullptr;
    std::uint32_t sources_ = 0;
};

}  // namespace axisgate::engine
