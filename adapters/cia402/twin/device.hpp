// Device: what stands behind the CANopen node of a twin: one servo or several, a controller with a memory of its own.
// In: objects written, the SYNC, time. Out: objects to be read, EMCY messages with the instant of their cause, the next instant at which
// something changes by itself. Never knows a frame.
#pragma once

#include <string_view>
#include <vector>

#include "gateway/core/twin.hpp"
#include "gateway/protocols/canopen/dictionary.hpp"
#include "gateway/protocols/canopen/emergency.hpp"

namespace axisgate::cia402_drive::twin {

class Device {
public:
    struct Reported {
        Instant at;
        canopen::Emergency emergency;
    };
    virtual ~Device() = default;

    virtual void power_on(Instant now) = 0;
    virtual void power_off(Instant now) = 0;
    [[nodiscard]] virtual bool powered() const = 0;  ///< a stage of it is on
    /// Asked before a write takes effect; what it does is done by `written`.
    [[nodiscard]] virtual canopen::Abort may_write(canopen::Address address, std::int64_t value, Instant now) const = 0;
    virtual void written(canopen::Address address, Instant now) = 0;
    /// The targets of cyclic modes that came by PDO are taken over.
    virtual void on_sync(Instant now) = 0;
    /// Sets the objects that are measured.
    virtual void refresh(Instant now) = 0;
    /// What happens by itself until then, one event at a time.
    [[nodiscard]] virtual Instant next_event(Instant now) const = 0;
    virtual void on_event(Instant at) = 0;
    /// Communication was lost or stopped (6007h).
    virtual void connection_lost(Instant now) = 0;
    [[nodiscard]] virtual std::vector<Reported> take_reported() = 0;

    /// Which objects the node itself keeps by 1010h.
    [[nodiscard]] virtual bool keeps(canopen::Address address, const canopen::Entry& entry) const = 0;
    /// A memory of its own beside the node's: added when the node stores, taken when power comes.
    virtual void save(NonVolatile& memory) { (void)memory; }
    virtual void load(const NonVolatile& memory) { (void)memory; }
};

}  // namespace axisgate::cia402_drive::twin
