// Server: the Modbus/TCP door: listeners, the limit on connections, and the time-outs, on the hot thread's io_context.
// In: bind addresses, a DoorPort. Out: served clients; counters for /metrics.
// Never blocks, never uses descriptor sets (select), and never lets one client's bytes, silence or slowness delay another's answer.
//
// What happens at the bounds:
//   connections     at `max_connections` one gives way for a new one, see gateway/core/places.hpp: first those that have never commanded
//   and
//                   stand still, of the address that has most of them. Never the newest 16 of an address that command (a write on its way,
//                   or an axis moving that it set in motion under Modbus' authority), and one whose last request is younger than
//                   `idle_before_eviction` only if its address has more than an eighth of all. An eighth more places are kept for
//                   addresses that have commanded. If none is left to close, the new one is refused (closed at once).
//   idle            a connection without a request for `idle_timeout` is closed, unless it commands.
//   half a request  is closed `partial_timeout` after its first byte, however slowly further bytes drip in.
//   not reading     a client that takes no answers is not read from while some wait (at most 64 KiB here and the kernel's socket
//                   buffers, which are set to 64 KiB each way), and closed when it has taken nothing for `stall_timeout`.
//   no descriptor   one gives way as for a place; if none is left to close, one client is taken by the descriptor that is kept for it.
//   in flight       32 writes per connection, 4096 in all (then exception 6); reads behind a write wait for it.
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
    /// Puts itself into the port's list of doors. `io`, `port` and `image` outlive it. Everything on the thread that runs `io`.
    Server(boost::asio::io_context& io, DoorPort& port, registers::RegisterImage& image, ServerSettings settings);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Listens on "ADDRESS:PORT", one or several. Empty: all are open; else none is, and this says which one failed, why, and what to do.
    [[nodiscard]] std::string open(std::span<const std::string> binds);
    /// What is listened on, with the ports that the system chose.
    [[nodiscard]] std::vector<std::string> addresses() const;
    /// Closes listeners and connections. Commands on their way go on.
    void close();

    /// What one client has done since it connected.
    struct ConnectionReport {
        std::string peer;
        std::uint64_t requests = 0, writes = 0, exceptions = 0;
        Instant since{};
    };
    [[nodiscard]] std::vector<ConnectionReport> connections() const;
    /// The locks, which can be changed while it serves.
    [[nodiscard]] Responder& responder() noexcept;
    /// Applies the time-outs as of the port's now(). The server's own timer calls it four times a second while anyone is connected.
    void sweep();

    /// May be read on any thread while the server lives.
    [[nodiscard]] const Counters& counters() const noexcept;
    [[nodiscard]] const registers::RegisterWriter::Counters& write_counters() const noexcept;

private:
    class Impl;
    std::shared_ptr<Impl> impl_;
};

}  // namespace axisgate::modbus
