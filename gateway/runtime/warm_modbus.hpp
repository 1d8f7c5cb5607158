// The Modbus port: reports of the door, which runs on the hot thread, and its read-only lock, which is stored. The door is known only by
// two functions; without them there is none.
#pragma once

#include "gateway/runtime/warm_events.hpp"
#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/modbus.hpp"

namespace axisgate {

class WarmModbus final : public ModbusPort {
public:
    WarmModbus(const WarmThreads& threads, WarmEvents& events) : threads_(threads), events_(events) {}
    /// Both are called on the hot thread.
    struct Door {
        std::function<ModbusReport()> report;
        std::function<void(bool)> set_read_only;
    };
    /// Before the start.
    void use(Door door) { door_ = std::move(door); }
    void modbus_report(std::function<void(std::optional<ModbusReport>)> then) override;
    void set_modbus_read_only(bool on, Origin origin, std::function<void(std::string fault, bool not_stored)> then) override;

private:
    void put_in_force(bool on, const Origin& origin, const std::function<void(std::string, bool)>& then);

    const WarmThreads& threads_;
    WarmEvents& events_;
    Door door_;
};

}  // namespace axisgate
