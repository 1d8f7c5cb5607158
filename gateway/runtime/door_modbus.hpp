// The Modbus door's descriptor: Modbus/TCP and Modbus RTU, their tables in the configuration.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/line_uri.hpp"
#include "gateway/runtime/door_descriptor.hpp"

namespace axisgate {

struct ModbusSettings {
    std::string bind = "127.0.0.1:1502";  ///< [modbus] bind; empty: no Modbus/TCP door
    std::int64_t idle_timeout_s = 60;     ///< [modbus] idle_timeout_s, 1..86400
    std::int64_t max_connections = 1024;  ///< [modbus] max_connections, 1..8192
    std::vector<std::string> allow;       ///< [modbus] allow: addresses and networks that may connect; empty: all
    std::vector<std::string> functions;   ///< [modbus] functions: function codes that are accepted; empty: all
    bool read_only = false;               ///< [modbus] read_only: writes other than a pure stop get exception 1
    /// [modbus_rtu] port: path of a serial port, or the URI of a byte line (serial:, tcp:, tcp-listen:, pty:); empty: no Modbus RTU door
    std::string rtu_port;
    std::int64_t rtu_baud = 19200;   ///< [modbus_rtu] baud, 50..12000000 bit/s, if the URI does not contain it
    std::string rtu_format = "8E1";  ///< [modbus_rtu] format, 8 data bits, if the URI does not contain it
    std::int64_t rtu_unit = 1;       ///< [modbus_rtu] unit, 1..247: slave address of this gateway
};

/// The serial port of the Modbus RTU door.
struct RtuPort {
    bool used = false;
    LineUri uri;
    std::string name;        ///< for messages: "/dev/ttyUSB0"; for other kinds of lines the URI without options
    std::uint32_t baud = 0;  ///< bit/s, for the silence between frames; also if the line itself has no bit rate
    SerialFormat format;
    std::string fault;  ///< why it cannot be used, and what a valid setting would be
};
[[nodiscard]] RtuPort rtu_port(const Config& config);

extern const DoorDescriptor modbus_door;

}  // namespace axisgate
