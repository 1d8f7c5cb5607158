// TcpListenLine: a TCP port through which up to four programs share the line, as on a bus: each one receives everything.
// Bytes of a client go to the line and to the other clients; frames of the line go to every client. A client that does not read is
// closed and counted when more than 64 KiB wait for it. A fifth client is rejected and counted.
#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/lines/real_line.hpp"

namespace axisgate {

class TcpListenLine final : public RealLine {
public:
    static constexpr std::size_t most_clients = 4;
    static constexpr std::size_t most_unsent = 64 * 1024;  ///< bytes per client

    struct Counters {
        std::uint64_t accepted = 0;     ///< clients that were accepted
        std::uint64_t turned_away = 0;  ///< clients that were rejected because four were connected
        std::uint64_t slow_closed = 0;  ///< clients that were closed because they did not read
    };

    TcpListenLine(const LineBase& base, std::string host, std::uint16_t port);
    ~TcpListenLine() override { close(); }

    /// The address it listens on, with the port that the system chose for port 0: "127.0.0.1:41234"; empty while it does not listen.
    [[nodiscard]] const std::string& address() const noexcept { return address_; }
    [[nodiscard]] std::uint16_t port() const noexcept { return bound_port_; }
    [[nodiscard]] std::size_t clients() const noexcept { return clients_.size(); }
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }

private:
    struct Client;

    void start() override;
    void stop() override;
    void flush() override;
    [[nodiscard]] std::string up_text() const override;

    void accept();
    void let_in(asio::ip::tcp::socket socket);
    void begin_reading(const std::shared_ptr<Client>& client);
    void on_readable(const std::shared_ptr<Client>& client);
    [[nodiscard]] bool hand_up(const std::shared_ptr<Client>& client, std::size_t size);
    void give(const std::shared_ptr<Client>& client, std::span<const std::uint8_t> data);
    void write(const std::shared_ptr<Client>& client);
    void drop(const std::shared_ptr<Client>& client);

    std::string host_;
    std::uint16_t port_number_;
    std::optional<asio::ip::tcp::acceptor> acceptor_;
    asio::steady_timer accept_pause_;
    std::vector<std::shared_ptr<Client>> clients_;
    std::string address_;
    std::uint16_t bound_port_ = 0;
    Counters counters_;
    std::vector<std::uint8_t> batch_;
    std::vector<Frame> sent_;
    std::array<std::uint8_t, 4096> buffer_;
};

}  // namespace axisgate
