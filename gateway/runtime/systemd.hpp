// The reports of a service to its manager, over the socket in $NOTIFY_SOCKET; none if there is no such socket. A failure has no effect on
// the service.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

namespace axisgate {

/// "READY=1", "STOPPING=1", "WATCHDOG=1", "STATUS=..." (several may be joined by line ends). Returns false if the manager has no place for
/// the message at the moment (the kernel keeps about ten for a reader that is busy), so that it should be sent again; true if it was sent,
/// or if there is no manager. Never waits.
bool notify_manager(std::string_view state) noexcept;
/// Half of the watchdog's period, if the manager monitors this process.
[[nodiscard]] std::optional<std::chrono::microseconds> watchdog_interval() noexcept;

}  // namespace axisgate
