// Handshakes, subscriptions and frames of many live-feed clients on one poller. The clients send only subscriptions and pongs.
#include "tests/bench/stream_crowd.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <string_view>

#include "tests/bench/http_load.hpp"

namespace axisgate::bench {
namespace {
constexpr std::size_t most_frame = 1 << 20;
using Client = Crowd::Client;

bool send_all(int fd, std::string_view bytes) {
    return ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

/// A client's frame with a mask of zero.
std::string client_frame(int opcode, std::string_view payload) {
    std::string f{static_cast<char>(0x80 | opcode)};
    if (payload.size() < 126) {
        f += static_cast<char>(0x80 | payload.size());
    } else {
        f += static_cast<char>(0x80 | 126);
        f += static_cast<char>(payload.size() >> 8);
        f += static_cast<char>(payload.size() & 0xFF);
    }
    f.append(4, '\0');
    return f.append(payload);
}

/// Handshake and the page's subscriptions, with the axes at `period_ms`.
bool open_client(Client& c, Address address, int period_ms, Crowd::Watches what) {
    c.fd = connect_blocking(address);
    if (c.fd < 0) return false;
    const std::string host = "127.0.0.1:" + std::to_string(address.port);
    if (!send_all(c.fd, "GET /api/v1/stream HTTP/1.1\r\nHost: " + host +
                            "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nOrigin: http://" + host +
                            "\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"))
        return false;
    std::array<char, 4096> part{};
    while (c.in.find("\r\n\r\n") == std::string::npos) {
        const auto n = ::recv(c.fd, part.data(), part.size(), 0);
        if (n <= 0 || c.in.size() > 16'384) return false;
        c.in.append(part.data(), static_cast<std::size_t>(n));
    }
    if (!c.in.starts_with("HTTP/1.1 101 ")) return false;
    c.in.erase(0, c.in.find("\r\n\r\n") + 4);
    const auto subscribe = [&](const std::string& topics, int period) {
        return send_all(c.fd, client_frame(1, R"({"subscribe":[)" + topics + R"(],"period_ms":)" + std::to_string(period) + "}"));
    };
    if (!subscribe(R"("axes/*")", period_ms)) return false;
    return what == Crowd::Watches::axes || (subscribe(R"("site","events","alarms")", 1000) && subscribe(R"("drives/*","lines/*")", 500));
}

/// Removes the complete frames from the received bytes. Returns false if the connection was closed, or the frame cannot come from a server.
bool take(Client& c) {
    static std::array<char, 256 * 1024> part;
    const auto n = ::recv(c.fd, part.data(), part.size(), MSG_DONTWAIT);
    if (n < 0 && errno == EAGAIN) return true;
    if (n <= 0) return false;
    const double now = now_s();
    c.gap_s = std::max(c.gap_s, now - c.received_s);
    c.received_s = now;
    c.bytes += static_cast<std::size_t>(n);
    c.in.append(part.data(), static_cast<std::size_t>(n));
    std::size_t at = 0;
    for (;;) {
        const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(c.in[at + i]); };
        if (c.in.size() - at < 2) break;
        std::size_t size = byte(1), head = 2;
        if (size == 126) {
            if (c.in.size() - at < 4) break;
            size = static_cast<std::size_t>(byte(2) << 8 | byte(3));
            head = 4;
        } else if (size > 126) {
            return false;  // masked, or larger than any message here
        }
        if (size > most_frame) return false;
        if (c.in.size() - at < head + size) break;
        const std::string_view payload(c.in.data() + at + head, size);
        switch (byte(0)) {
            case 0x81:
                if (payload.starts_with(R"({"topic":"axes/)")) {
                    ++c.axes;
                } else {
                    ++c.others;
                }
                break;
            case 0x89:
                if (!send_all(c.fd, client_frame(10, payload))) return false;
                break;
            default:
                return false;
        }
        at += head + size;
    }
    c.in.erase(0, at);
    return true;
}
}  // namespace

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Crowd::Crowd(Address address, std::size_t count, int period_ms, Watches what) : poller_(::epoll_create1(0)), clients_(count) {
    for (std::size_t i = 0; i < count && good_; ++i) {
        good_ = open_client(clients_[i], address, period_ms, what);
        epoll_event e{};
        e.events = EPOLLIN;
        e.data.u64 = i;
        ::epoll_ctl(poller_, EPOLL_CTL_ADD, clients_[i].fd, &e);
        run(0.002);
    }
}
Crowd::~Crowd() {
    for (const auto& c : clients_)
        ::close(c.fd);
    ::close(poller_);
}
void Crowd::run(double seconds) {
    const double end = now_s() + seconds;
    epoll_event events[128];
    while (good_ && now_s() < end) {
        const int n = ::epoll_wait(poller_, events, 128, 10);
        for (int i = 0; i < n && good_; ++i)
            good_ = take(clients_[events[i].data.u64]);
    }
}
void Crowd::forget() {
    for (auto& c : clients_) {
        c.axes = c.others = c.bytes = 0;
        c.gap_s = 0;
        c.received_s = now_s();
    }
}

}  // namespace axisgate::bench
