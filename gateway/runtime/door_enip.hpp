// The EtherNet/IP door's descriptor.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/runtime/door_descriptor.hpp"

namespace axisgate {

struct EnipSettings {
    std::string bind = "127.0.0.1:44818";  ///< [enip] bind, IPv4, TCP and UDP; empty: no EtherNet/IP door
    bool bind_named = false;               ///< the configuration names the address: then a port in use is a fault
    std::int64_t io_port = 2222;           ///< [enip] io_port, 0..65535: UDP, implicit data; originators use 2222 unless configured
    bool io_port_named = false;            ///< as bind_named
};

extern const DoorDescriptor enip_door;

}  // namespace axisgate
