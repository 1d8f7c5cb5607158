// Host facts: how this host is reached on the address that the door listens on: mask, hardware address, name.
// In: an IPv4 address (0: any). Out: what the TCP/IP Interface and Ethernet Link objects show. Never changes anything, asks no name server.
#pragma once

#include "gateway/doors/enip/layout.hpp"

namespace axisgate::enip {

/// For any address: that of the first interface that is up and not the loopback; else 127.0.0.1.
[[nodiscard]] HostFacts host_facts(std::uint32_t address);

}  // namespace axisgate::enip
