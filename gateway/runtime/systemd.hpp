// systemd: the three things that a service tells its manager, over the socket that it names in the environment.
// In: states. Out: datagrams to $NOTIFY_SOCKET; nothing if there is none. Never fails the service.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

namespace axisgate {

/// "READY=1", "STOPPING=1", "WATCHDOG=1", "STATUS=..." (several may be joined by line ends).
void notify_manager(std::string_view state) noexcept;
/// Half of the watchdog's period, if the manager watches this process.
[[nodiscard]] std::optional<std::chrono::microseconds> watchdog_interval() noexcept;

}  // namespace axisgate
