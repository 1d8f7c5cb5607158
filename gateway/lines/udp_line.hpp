// UdpLine: datagrams to and from a drive (udp:HOST:PORT), or with the peer that has sent to us last (udp-listen:HOST:PORT, for twins).
// Each frame is sent as one datagram; each datagram is received as frames of at most their capacity. UDP has no connection, so the line
// is up as soon as its socket is open; whether a drive is there shows only in its answers.
#pragma once

#include <array>
#include <boost/asio/ip/udp.hpp>
#include <optional>
#include <string>

#include "gateway/lines/real_line.hpp"

namespace axisgate {

class UdpLine final : public RealLine {
public:
    /// Connecting: only datagrams of that host and port are accepted, and the line goes down and reopens if no program listens on that
    /// port.
    /// Listening: answers go to the peer that has sent last; before that, frames to send are dropped and counted. Port 0: the system
    /// chooses.
    enum class Role : std::uint8_t { connects, listens };
    UdpLine(const LineBase& base, std::string host, std::uint16_t port, Role role);
    ~UdpLine() override { close(); }

    /// The port in use; 0 while the line is not up.
    [[nodiscard]] std::uint16_t port() const;

    /// This many datagrams are read or written before other work of the loop has its turn.
    static constexpr int datagrams_per_turn = 16;

private:
    using udp = asio::ip::udp;
    void start() override;
    void stop() override;
    void flush() override;
    void resolved(const boost::system::error_code& error, const udp::resolver::results_type& found);
    void use(const udp::endpoint& where);
    void lost(const boost::system::error_code& error);
    void wait_readable();
    void on_readable();
    [[nodiscard]] std::string name() const;

    std::string host_;
    std::uint16_t port_number_;
    Role role_;
    udp::resolver resolver_;
    std::optional<udp::socket> socket_;
    std::optional<udp::endpoint> last_speaker_;
    std::array<std::uint8_t, 65536> buffer_{};
    bool write_waits_ = false;
    bool resolving_ = false;
    bool awaits_name_ = false;  ///< the present attempt waits for the resolver
    std::size_t address_turn_ = 0;
    std::shared_ptr<char> alive_ = std::make_shared<char>();
};

}  // namespace axisgate
