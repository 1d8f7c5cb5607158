// The DDS door's descriptor.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/runtime/door_descriptor.hpp"

namespace axisgate {

struct DdsSettings {
    bool enabled = false;               ///< [dds] enabled
    std::int64_t domain = 0;            ///< [dds] domain, 0..232
    std::string partition = "plant";    ///< [dds] partition: gateways of different partitions do not see each other
    std::string name;                   ///< [dds] name of this gateway in the domain, 1..63 bytes; empty: the host's name
    std::string interface_name = "lo";  ///< [dds] interface: network interface; lo: this computer only
    std::string security;               ///< [dds] security: folder made by `axisgate pki`; empty: off, every participant of the domain is
                                        ///< trusted
};

extern const DoorDescriptor dds_door;

}  // namespace axisgate
