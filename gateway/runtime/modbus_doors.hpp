// ModbusDoors holds Modbus/TCP and Modbus RTU as configured, with one read-only lock and one report for both. They are opened on the hot
// thread and report to the service thread.
#pragma once

#include <memory>
#include <string>

#include "gateway/core/line_uri.hpp"
#include "gateway/doors/modbus/rtu_door.hpp"
#include "gateway/doors/modbus/server.hpp"
#include "gateway/runtime/door_modbus.hpp"
#include "gateway/runtime/hot.hpp"
#include "gateway/services/ports/modbus.hpp"

namespace axisgate {

class ModbusDoors {
public:
    /// Called before the hot thread starts. `read_only` is the last state of the lock.
    ModbusDoors(Hot& hot, registers::RegisterImage& image, const Config& config, bool read_only);
    /// Empty: Modbus/TCP listens, and the serial port is being opened; a failure of the latter is reported and repeated. Otherwise the
    /// reason why Modbus/TCP does not listen; the call can be repeated. On the hot thread, or before it starts.
    [[nodiscard]] std::string open();
    [[nodiscard]] bool any() const noexcept { return tcp_ || rtu_; }

    /// On the hot thread.
    [[nodiscard]] ModbusReport report() const;
    void set_read_only(bool on);

private:
    void add(ModbusReport& report, ModbusConnection connection, std::string_view host) const;

    Hot& hot_;
    const ModbusSettings settings_;
    std::unique_ptr<modbus::Server> tcp_;
    std::unique_ptr<modbus::RtuDoor> rtu_;
    bool rtu_opened_ = false;
};

}  // namespace axisgate
