// TcpLine: a TCP connection to a drive or a serial server, opened by the gateway.
// If the peer closes its side, the line goes down and connects again. One address is given at most 3 s, and one attempt tries at most
// four addresses of a name.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/lines/stream_line.hpp"

namespace axisgate {

class TcpLine final : public StreamLine {
public:
    TcpLine(const LineBase& base, std::string host, std::uint16_t port, Duration connect_limit = std::chrono::seconds(3));
    ~TcpLine() override { close(); }

private:
    void start() override;
    void stop() override;
    void on_gone(int error) override;
    void resolved(const boost::system::error_code& error, const asio::ip::tcp::resolver::results_type& found);
    void connect_next(std::string why);
    void connected();
    [[nodiscard]] std::string name() const;

    std::string host_;
    std::uint16_t port_number_;
    Duration connect_limit_;
    asio::ip::tcp::resolver resolver_;
    asio::steady_timer limit_;
    std::optional<asio::ip::tcp::socket> connecting_;
    std::vector<asio::ip::tcp::endpoint> to_try_;  // in reverse order: the next one is the last element
    bool resolving_ = false;                       // one request at a time: a request to the system's resolver cannot be cancelled
    std::shared_ptr<char> alive_ = std::make_shared<char>();
};

}  // namespace axisgate
