// Device is the part of a twin behind its CANopen node: one servo or several, or a controller with its own memory. It works on objects and
// instants and knows no frames.
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
    [[nodiscard]] virtual bool powered() const = 0;  ///< the power stage of an axis is on
    /// Called before a write takes effect; `written` carries it out.
    [[nodiscard]] virtual canopen::Abort may_write(canopen::Address address, std::int64_t value, Instant now) const = 0;
    virtual void written(canopen::Address address, Instant now) = 0;
    /// The targets of cyclic modes that were received by PDO take effect.
    virtual void on_sync(Instant now) = 0;
    /// Updates the objects that contain measured values.
    virtual void refresh(Instant now) = 0;
    /// The next instant at which the state changes without a request; each such event is handled separately.
    [[nodiscard]] virtual Instant next_event(Instant now) const = 0;
    virtual void on_event(Instant at) = 0;
    /// Communication was lost or stopped (6007h).
    virtual void connection_lost(Instant now) = 0;
    [[nodiscard]] virtual std::vector<Reported> take_reported() = 0;

    /// Which objects the node itself stores by 1010h.
    [[nodiscard]] virtual bool keeps(canopen::Address address, const canopen::Entry& entry) const = 0;
    /// Memory of the device beside the node's: added when the node stores, restored at power-on.
    virtual void save(NonVolatile& memory) { (void)memory; }
    virtual void load(const NonVolatile& memory) { (void)memory; }
};

}  // namespace axisgate::cia402_drive::twin
