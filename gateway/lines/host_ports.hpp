// Host ports: lists the serial ports and CAN interfaces of this machine.
// It returns at most `most_host_ports` of them, CAN interfaces first, each by its name. No port is opened or queried.
#pragma once

#include <filesystem>
#include <vector>

#include "gateway/core/system_port.hpp"

namespace axisgate {

inline constexpr std::size_t most_host_ports = 256;  ///< further ports are not listed

/// Reads /sys/class/net, /sys/class/tty and /dev/serial/by-id below `root` at each call. Entries that cannot be read are left out.
[[nodiscard]] std::vector<SystemPort> host_ports(const std::filesystem::path& root = "/");

}  // namespace axisgate
