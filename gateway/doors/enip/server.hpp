// Server: the EtherNet/IP door: its sockets on the hot thread's io_context around the adapter, and the adapter's values.
// In: a bind address, a DoorPort, the register image. Out: served originators; counters for /metrics; events of connections.
// Never blocks, never waits for a client. Bounds: sessions and connections are the adapter's (gateway/protocols/cip/adapter.hpp); what a
// client does not read is kept up to `most_unsent` bytes, then it is closed; of each UDP socket `datagrams_per_turn` are taken in a turn.
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>
#include <vector>

#include "gateway/doors/enip/axis_values.hpp"
#include "gateway/engine/door.hpp"
#include "gateway/protocols/cip/adapter.hpp"

namespace axisgate::enip {

struct ServerSettings {
    std::uint16_t io_port = cip::default_io_port;  ///< UDP, implicit data; 0: any
    /// Nobody chose it: where another program has it, any other is taken, which each Forward_Open is told.
    bool another_io_port = false;
    std::int64_t lease_s = 30;      ///< with which a held axis is held on
    std::uint16_t incarnation = 1;  ///< another one at each start
};

class Server {
public:
    static constexpr std::size_t most_unsent = 64 * 1024;
    static constexpr int datagrams_per_turn = 32;
    static constexpr std::size_t answers_together = 16;  ///< so many sessions that are ready at once are answered together

    /// Puts itself into the port's list of doors. `io`, `port` and `image` outlive it. Everything on the thread that runs `io`.
    Server(boost::asio::io_context& io, DoorPort& port, registers::RegisterImage& image, ServerSettings settings);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Listens on "ADDRESS:PORT" (IPv4), TCP and UDP, and on the port for implicit data. Empty: good; else why not, and what to do.
    [[nodiscard]] std::string open(const std::string& bind);
    [[nodiscard]] std::vector<std::string> addresses() const;
    /// Of this host and the open ports; does not change while it is open. Any thread.
    [[nodiscard]] const HostFacts& facts() const noexcept;
    void close();
    [[nodiscard]] const cip::Adapter& adapter() const noexcept;

private:
    class Impl;
    std::shared_ptr<Impl> impl_;
};

}  // namespace axisgate::enip
