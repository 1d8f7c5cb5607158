// A real server on loopback and raw TCP clients, in one thread; the test provides the door's time. It waits only for the kernel, never for
// time to pass.
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "gateway/doors/modbus/server.hpp"
#include "tests/unit/modbus/responder_bench.hpp"

namespace axisgate::modbus::test {

struct Net {
    explicit Net(ServerSettings settings = {}) : server(std::make_unique<Server>(io, port, image, settings)) {
        for (std::uint16_t n = 1; n <= 4; ++n)
            axes[n] = port.add_axis(n, &catalogue());
        port.edit(axes[1], [](AxisPicture& p) { p.statusword = 0x0250; });
        const std::string bind = "127.0.0.1:0";
        EXPECT_EQ(server->open(std::span(&bind, 1)), "");
        tcp_port = port_of(server->addresses().at(0));
    }
    static std::uint16_t port_of(const std::string& address) {
        return static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
    }
    /// Lets the server do everything that can be done now.
    void turn() {
        io.restart();
        while (io.poll() > 0) {
        }
    }
    /// Advances the time, and the server checks its time-outs.
    void pass(Duration d) {
        port.time += d;
        server->sweep();
        turn();
    }

    boost::asio::io_context io;
    FakePort port;
    registers::RegisterImage image{port, {}};
    std::unique_ptr<Server> server;
    std::uint16_t tcp_port = 0;
    AxisId axes[5] = {};
};

class TcpClient {
public:
    explicit TcpClient(Net& net, int receive_buffer = 0) : net_(net), fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        if (receive_buffer > 0) ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        const int on = 1;
        ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    }
    TcpClient(TcpClient&& other) noexcept : net_(other.net_), fd_(std::exchange(other.fd_, -1)) {}
    TcpClient(const TcpClient&) = delete;
    ~TcpClient() { close(); }

    TcpClient& connect(std::uint16_t tcp_port = 0) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(tcp_port ? tcp_port : net_.tcp_port);
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(fd_, reinterpret_cast<sockaddr*>(&to), sizeof to), 0) << std::strerror(errno);
        ::fcntl(fd_, F_SETFL, O_NONBLOCK);
        net_.turn();
        return *this;
    }
    void close() {
        if (fd_ >= 0) ::close(std::exchange(fd_, -1));
    }
    void end_sending() {
        ::shutdown(fd_, SHUT_WR);
        net_.turn();
    }
    /// Returns false if the connection is closed.
    bool send(std::string_view data) {
        const auto b = bytes(data);
        const auto n = ::send(fd_, b.data(), b.size(), MSG_NOSIGNAL);
        net_.turn();
        return n == static_cast<ssize_t>(b.size());
    }
    /// The next `n` bytes; fewer if the server closed, or sent none for two seconds.
    std::string receive(std::size_t n) {
        std::vector<std::uint8_t> got;
        while (got.size() < n) {
            std::uint8_t buffer[4096];
            const auto r = ::recv(fd_, buffer, std::min(sizeof buffer, n - got.size()), 0);
            if (r > 0) {
                got.insert(got.end(), buffer, buffer + r);
                continue;
            }
            if (r == 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) {
                closed_ = true;
                break;
            }
            net_.turn();
            if (!readable(++waits_ > 200 ? 0 : 10)) {
                if (waits_ > 200) break;
            }
        }
        waits_ = 0;
        return hex(got);
    }
    std::string ask(std::string_view request, std::size_t answer_size) {
        send(request);
        return receive(answer_size);
    }
    /// True if there is nothing to read, and the connection is open.
    bool quiet() {
        net_.turn();
        return !readable(0);
    }
    bool closed() {
        net_.turn();
        if (!closed_ && readable(50)) {
            std::uint8_t byte;
            const auto r = ::recv(fd_, &byte, 1, MSG_PEEK);
            closed_ = r == 0 || (r < 0 && errno == ECONNRESET);
        }
        return closed_;
    }
    [[nodiscard]] int fd() const { return fd_; }

private:
    bool readable(int ms) const {
        pollfd p{fd_, POLLIN, 0};
        return ::poll(&p, 1, ms) > 0;
    }
    Net& net_;
    int fd_;
    int waits_ = 0;
    bool closed_ = false;
};

}  // namespace axisgate::modbus::test
