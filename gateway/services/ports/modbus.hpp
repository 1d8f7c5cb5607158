// Modbus port: the Modbus door's locks and clients, as other doors show and set them.
// In: the lock that can be set while it runs. Out: a report, by callbacks on the service thread.
// Never a way to registers: that is the register port.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/command.hpp"

namespace axisgate {

struct ModbusConnection {
    std::string peer;
    std::uint64_t requests = 0, writes = 0, exceptions = 0;
    std::int64_t since_unix_ns = 0;
    std::vector<std::string> holds;  ///< axes
};
struct ModbusReport {
    std::string bind;
    std::vector<std::string> allow, functions;  ///< empty: all
    bool read_only = false;
    std::vector<ModbusConnection> connections;
};

class ModbusPort {
public:
    virtual ~ModbusPort() = default;
    /// Nothing: there is no Modbus door, or it is too busy to say.
    virtual void modbus_report(std::function<void(std::optional<ModbusReport>)> then) = 0;
    /// Empty: done and stored; else why not, and whether it was the database that could not keep it.
    virtual void set_modbus_read_only(bool on, Origin origin, std::function<void(std::string fault, bool not_stored)> then) = 0;
};

}  // namespace axisgate
