// Publisher: everything that the engine tells, in one place.
// In: what has become of axes, commands and parameters. Out: pictures into the image, results, events and samples to the host; each of them
// to the tap, too, if there is one.
// Never decides anything: what is told has happened.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Publisher {
public:
    Publisher(Machine& machine, EngineHost& host) : machine_(machine), host_(host) {}
    /// Null: nobody listens.
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
