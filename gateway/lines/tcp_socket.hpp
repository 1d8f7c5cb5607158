// TCP socket: the options that both TCP lines set on their connections, for short delays and to detect a dead peer within seconds.
// An option that the system does not support is left out.
#pragma once

namespace axisgate {

/// No delay, keep-alive (10 s idle, then every 3 s, three times), 10 s for unacknowledged data, a small send buffer (bytes in it cannot
/// be overtaken by a stop).
void set_up_connection(int fd) noexcept;

}  // namespace axisgate
