// The locks and clients of the Modbus door, for other doors. The report comes by a callback on the service thread. Registers are reached
// through the register port.
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
    std::vector<std::string> holds;  ///< names of axes
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
    /// Empty if there is no Modbus door, or if it is too busy to answer.
    virtual void modbus_report(std::function<void(std::optional<ModbusReport>)> then) = 0;
    /// Empty if done and stored; otherwise the reason, and whether the database could not store it.
    virtual void set_modbus_read_only(bool on, Origin origin, std::function<void(std::string fault, bool not_stored)> then) = 0;
};

}  // namespace axisgate
