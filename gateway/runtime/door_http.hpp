// The HTTP door's descriptor.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/runtime/door_descriptor.hpp"

namespace axisgate {

struct HttpSettings {
    std::string bind = "127.0.0.1:8080";  ///< [http] bind; empty: no HTTP door
    std::string tls_cert, tls_key;        ///< [http] tls_cert, tls_key
    bool tls_self_signed = false;         ///< [http] tls = "off" | "self_signed": a certificate made by the gateway, in the data directory
    /// [http] allowed_hosts: names of this host in addition to its addresses and localhost; requests with other names get 421.
    std::vector<std::string> allowed_hosts;
    std::int64_t max_connections = 512;  ///< [limits] http_connections
};

extern const DoorDescriptor http_door;

}  // namespace axisgate
