// TCP socket: the options that both TCP lines give their connections.
// In: a connected socket. Out: the same, answering at once and noticing a dead peer within seconds.
// Never fails: an option that a system does not know is left out.
#pragma once

namespace axisgate {

/// No delay, keep-alive (10 s idle, then every 3 s, three times), 10 s for unacknowledged data, a small send buffer (what is in it can
/// not be overtaken by a stop).
void set_up_connection(int fd) noexcept;

}  // namespace axisgate
