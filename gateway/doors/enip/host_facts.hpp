// Mask, hardware address and name of this host on the address of the door, for the TCP/IP Interface and Ethernet Link objects (0: any
// address). No name server is asked.
#pragma once

#include "gateway/doors/enip/layout.hpp"

namespace axisgate::enip {

/// For any address: that of the first interface that is up and not the loopback; otherwise 127.0.0.1.
[[nodiscard]] HostFacts host_facts(std::uint32_t address);

}  // namespace axisgate::enip
