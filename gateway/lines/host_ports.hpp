// Host ports: which serial ports and CAN interfaces this machine has.
// In: the system's lists below a root. Out: at most `most_host_ports` of them, CAN first, each by its name. Opens no port and asks none.
#pragma once

#include <filesystem>
#include <vector>

#include "gateway/core/system_port.hpp"

namespace axisgate {

inline constexpr std::size_t most_host_ports = 256;  ///< what is beyond is not told

/// Read anew at each call: /sys/class/net, /sys/class/tty, /dev/serial/by-id below `root`. What cannot be read is left out.
[[nodiscard]] std::vector<SystemPort> host_ports(const std::filesystem::path& root = "/");

}  // namespace axisgate
