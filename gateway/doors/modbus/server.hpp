// Server is the Modbus/TCP door: listeners, the limit on connections, and the time-outs, on the hot thread's io_context. It never blocks
// and does not use select(); the bytes, silence or slowness of one client never delay the answers to another. At the limits:
// Connections: at `max_connections` one is closed for a new one (gateway/core/places.hpp): first those that have never commanded and are
// inactive, of the address that has most of them. The newest 16 of an address that commands (an outstanding write, or a moving axis that it
// has set in motion under Modbus authority) are never closed; one whose last request is younger than `idle_before_eviction` only if its
// address has more than an eighth of all. An additional eighth of the places is reserved for addresses that have commanded. If none can be
// closed, the new one is refused (closed at once).
// Idle: a connection without a request for `idle_timeout` is closed, unless it commands.
// Incomplete request: closed `partial_timeout` after its first byte, even if further bytes arrive slowly.
// Unread answers: while answers wait (at most 64 KiB here, and 64 KiB in each of the kernel's socket buffers), nothing is read from the
// client; it is closed when it has read nothing for `stall_timeout`.
// No descriptor: a connection is closed as for a place; if none can be closed, one client is accepted with the reserved descriptor.
// Outstanding writes: 32 per connection, 4096 in all (then exception 6); reads after a write wait for it.
#pragma once

#include <boost/asio/io_context.hpp>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gateway/doors/modbus/pdu.hpp"
#include "gateway/engine/door.hpp"

namespace axisgate::modbus {

struct ServerSettings {
    Responder::Settings responder;
    std::size_t max_connections = 1024;
    Duration idle_timeout = std::chrono::seconds(60);
    Duration idle_before_eviction = std::chrono::milliseconds(100);
    Duration partial_timeout = std::chrono::seconds(5);
    Duration stall_timeout = std::chrono::seconds(5);
};

class Server {
public:
    /// Adds itself to the port's list of doors. `io`, `port` and `image` must outlive it. All calls on the thread that runs `io`.
    Server(boost::asio::io_context& io, DoorPort& port, registers::RegisterImage& image, ServerSettings settings);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Listens on one or several "ADDRESS:PORT". Empty: all are open; otherwise none is, and the text has the address, the fault and the
    /// remedy.
    [[nodiscard]] std::string open(std::span<const std::string> binds);
    /// The addresses with the ports that the system has chosen.
    [[nodiscard]] std::vector<std::string> addresses() const;
    /// Closes listeners and connections. Outstanding commands continue.
    void close();

    /// The activity of one client since it connected.
    struct ConnectionReport {
        std::string peer;
        std::uint64_t requests = 0, writes = 0, exceptions = 0;
        Instant since{};
    };
    [[nodiscard]] std::vector<ConnectionReport> connections() const;
    /// The locks, which can be changed at run time.
    [[nodiscard]] Responder& responder() noexcept;
    /// Applies the time-outs at the port's now(). The server's timer calls it four times a second while there are connections.
    void sweep();

    /// Any thread, while the server exists.
    [[nodiscard]] const Counters& counters() const noexcept;
    [[nodiscard]] const registers::RegisterWriter::Counters& write_counters() const noexcept;

private:
    class Impl;
    std::shared_ptr<Impl> impl_;
};

}  // namespace axisgate::modbus
