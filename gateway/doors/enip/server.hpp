// Server is the EtherNet/IP door: its sockets on the hot thread's io_context, the CIP adapter, and its values. It never blocks or waits for
// a client. The numbers of sessions and connections are limited by the adapter (gateway/protocols/cip/adapter.hpp). Unread output of a
// client is stored up to `most_unsent` bytes, then the client is closed; at most `datagrams_per_turn` are read from each UDP socket per
// turn.
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
    /// The port was not configured: if another program uses it, any other one is used, which each Forward_Open reports.
    bool another_io_port = false;
    std::int64_t lease_s = 30;      ///< duration of the lease by which an axis is held
    std::uint16_t incarnation = 1;  ///< differs at each start
    bool owner_keeps_time = false;  ///< the port's time is not this computer's: the owner calls on_deadline()
};

class Server {
public:
    static constexpr std::size_t most_unsent = 64 * 1024;
    static constexpr int datagrams_per_turn = 32;
    static constexpr std::size_t answers_together = 16;  ///< from this number of ready sessions on, their answers are sent together

    /// Adds itself to the port's list of doors. `io`, `port` and `image` must outlive it. All calls on the thread that runs `io`.
    Server(boost::asio::io_context& io, DoorPort& port, registers::RegisterImage& image, ServerSettings settings);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Listens on "ADDRESS:PORT" (IPv4), TCP and UDP, and on the port for implicit data. Empty: open; otherwise the fault and the remedy.
    [[nodiscard]] std::string open(const std::string& bind);
    [[nodiscard]] std::vector<std::string> addresses() const;
    /// Facts of this host, and the open ports; constant while the door is open. Any thread.
    [[nodiscard]] const HostFacts& facts() const noexcept;
    void close();
    /// With `owner_keeps_time`: the instant of the port's time at which on_deadline() has something to do. It changes with each request.
    [[nodiscard]] Instant deadline() const;
    void on_deadline();
    [[nodiscard]] const cip::Adapter& adapter() const noexcept;

private:
    class Impl;
    std::shared_ptr<Impl> impl_;
};

}  // namespace axisgate::enip
