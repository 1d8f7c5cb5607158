// Server: the Modbus/TCP door: listeners, the limit on connections, and the time-outs, on the hot thread's io_context.
// In: bind addresses, a DoorPort. Out: served clients; counters for /metrics.
// Never blocks, never uses descriptor sets (select), and never lets one client's bytes, silence or slowness delay another's answer.
//
// What happens at the bounds:
//   connections     at `max_connections` one gives way for a new one, see gateway/core/places.hpp: first those that have never commanded and
//                   stand still, of the address that has most of them. Never the newest 16 of an address that command (a write on its way,
//                   or an axis moving that it set in motion under Modbus' authority), and one whose last request is younger than
//                   `idle_before_eviction` only if its address has more than an eighth of all. An eighth more places are kept for
//                   addresses that have commanded. If none is left to close, the new one is refused (closed at once).
//   idle            a connection without a request for `idle_timeout` is closed, unless it commands.
//   half a request  is closed `partial_timeout` after its first byte, however slowly further bytes drip in.
//   not reading     a client that takes no answers is not read from while some wait (at most 64 KiB here and the kernel's socket
//                   buffers, which are set to 64 KiB each way), and closed when it has taken nothing for `stall_timeout`.
//   in flight       32 writes per connection, 4096 in all (then exception 6); reads behind a write wait for it.
#pragma once

#include <boost/asio/io_context.hpp>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gateway/engine/door.hpp"
#include "gateway/doors/modbus/own_map.hpp"
#include "gateway/doors/modbus/pdu.hpp"

namespace axisgate::modbus {

struct ServerSettings {
    Responder::Settings responder;
    MapGaps gaps = MapGaps::zero;  ///< of units that the site does not name
    std::size_t max_connections = 1024;
    Duration idle_timeout = std::chrono::seconds(60);
    Duration idle_before_eviction = std::chrono::milliseconds(100);
    Duration partial_timeout = std::chrono::seconds(5);
    Duration stall_timeout = std::chrono::seconds(5);
};

class Server {
public:
    /// Its Responder attaches itself to the port as the sink of Door::modbus. `io` and `port` outlive it. Everything on the thread that
    /// runs `io`.
    Server(boost::asio::io_context& io, DoorPort& port, ServerSettings settings);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Listens on "ADDRESS:PORT", one or several. Empty: all are open; else none is, and this says which one failed, why, and what to do.
    [[nodiscard]] std::string open(std::span<const std::string> binds);
    /// What is listened on, with the ports that the system chose.
    [[nodiscard]] std::vector<std::string> addresses() const;
    /// Closes listeners and connections. Commands on their way go on.
    void close();

    /// Puts the site's own maps behind their units, and takes away those of before. What is on its way for them is answered to nobody.
    /// `gaps`: of units that do not follow the settings.
    void set_mappings(std::vector<PlacedMapping> mappings, const std::map<std::uint8_t, MapGaps>& gaps = {});
    /// A parameter value that a drive reported: own maps show it.
    void on_sample(const Sample& sample);

    /// A read request (functions 1 to 4) answered as any client would be: what the register view shows. On the thread of `io`; counts as a
    /// request, and asks for mapped parameters as one would. Empty for other functions.
    [[nodiscard]] std::vector<std::uint8_t> answer_read(std::uint8_t unit, std::span<const std::uint8_t> pdu);

    /// What one client has done since it connected.
    struct ConnectionReport {
        std::string peer;
        std::uint64_t requests = 0, writes = 0, exceptions = 0;
        Instant since{};
    };
    [[nodiscard]] std::vector<ConnectionReport> connections() const;
    /// For another transport of the same registers: there is one Responder per port.
    [[nodiscard]] Responder& responder() noexcept;
    /// Applies the time-outs as of the port's now(). The server's own timer calls it four times a second while anyone is connected.
    void sweep();

    /// Serves the requests that are there at this moment; false: there was none. For a loop that polls instead of sleeping.
    bool serve_now();

    /// May be read on any thread while the server lives.
    [[nodiscard]] const Counters& counters() const noexcept;

private:
    class Impl;
    std::shared_ptr<Impl> impl_;
};

}  // namespace axisgate::modbus
