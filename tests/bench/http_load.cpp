// Requests, answers and their times on one poller. Bodies are not read, and a connection has one request at a time.
#include "tests/bench/http_load.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>

namespace axisgate::bench {
namespace {
std::int64_t now_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Size of the whole answer that begins with `in`; 0: its head is incomplete; npos: it is not the expected answer.
std::size_t size_of_answer(const std::string& in) {
    const auto end = in.find("\r\n\r\n");
    if (end == std::string::npos) return in.size() > 16'384 ? std::string::npos : 0;
    const auto field = in.find("\r\nContent-Length: ");
    if (!in.starts_with("HTTP/1.1 200 ") || field == std::string::npos || field > end) return std::string::npos;
    return end + 4 + static_cast<std::size_t>(std::strtoul(in.c_str() + field + 18, nullptr, 10));
}
}  // namespace

std::string http_request(Address address, const std::string& method, const std::string& path, const std::string& body) {
    std::string r =
        method + " " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(address.port) + "\r\nAccept: application/json\r\n";
    if (!body.empty()) r += "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n";
    return r + "\r\n" + body;
}

int connect_blocking(Address address) {
    const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_port = htons(address.port);
    a.sin_addr.s_addr = htonl(address.host);
    if (::connect(fd, reinterpret_cast<sockaddr*>(&a), sizeof a) != 0) {
        ::close(fd);
        return -1;
    }
    const int on = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    const timeval limit{2, 0};
    ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    return fd;
}

HttpAnswer ask_once(Address address, const std::string& path) {
    const int fd = connect_blocking(address);
    if (fd < 0) return {};
    const std::string request = http_request(address, "GET", path, {});
    std::string in;
    std::array<char, 16'384> part{};
    HttpAnswer out;
    if (::send(fd, request.data(), request.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(request.size())) {
        for (;;) {
            const auto n = ::recv(fd, part.data(), part.size(), 0);
            if (n <= 0) break;
            in.append(part.data(), static_cast<std::size_t>(n));
            const auto size = size_of_answer(in);
            if (size == std::string::npos) break;
            if (size == 0 || in.size() < size) continue;
            const auto end = in.find("\r\n\r\n");
            out = {in.substr(0, end), in.substr(end + 4, size - end - 4)};
            break;
        }
    }
    ::close(fd);
    return out;
}

HttpLoad::HttpLoad(Address address, const std::string& path, int connections, const std::string& method, const std::string& body)
    : poller_(::epoll_create1(0)),
      request_(http_request(address, method, path, body)),
      connections_(static_cast<std::size_t>(connections)) {
    latencies_ns_.reserve(1u << 20);
    for (std::size_t i = 0; i < connections_.size(); ++i) {
        connections_[i].fd = connect_blocking(address);
        if (connections_[i].fd < 0) fault_ = std::string("cannot connect: ") + std::strerror(errno);
        epoll_event e{};
        e.events = EPOLLIN;
        e.data.u64 = i;
        ::epoll_ctl(poller_, EPOLL_CTL_ADD, connections_[i].fd, &e);
    }
}

HttpLoad::~HttpLoad() {
    for (auto& c : connections_) {
        if (c.fd >= 0) ::close(c.fd);
    }
    ::close(poller_);
}

void HttpLoad::ask(Connection& c) {
    c.sent_at = now_ns();
    c.wanted = 0;
    c.in.clear();
    if (::send(c.fd, request_.data(), request_.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request_.size()))
        fault_ = std::string("cannot send: ") + std::strerror(errno);
}

bool HttpLoad::take(Connection& c) {
    std::array<char, 16'384> part;
    const auto n = ::recv(c.fd, part.data(), part.size(), MSG_DONTWAIT);
    if (n <= 0) {
        if (n < 0 && errno == EAGAIN) return false;
        fault_ = "the server closed a connection";
        return false;
    }
    c.in.append(part.data(), static_cast<std::size_t>(n));
    if (c.wanted == 0) c.wanted = size_of_answer(c.in);
    if (c.wanted == std::string::npos || (c.wanted > 0 && c.in.size() > c.wanted)) fault_ = "a wrong answer: " + c.in.substr(0, 200);
    if (!fault_.empty() || c.wanted == 0 || c.in.size() < c.wanted) return false;
    latencies_ns_.push_back(static_cast<std::uint32_t>(std::min<std::int64_t>(now_ns() - c.sent_at, UINT32_MAX)));
    return true;
}

LoadResult HttpLoad::run(double seconds) {
    LoadResult result;
    if (!fault_.empty()) return result;
    latencies_ns_.clear();
    const std::int64_t start = now_ns();
    const std::int64_t end = start + static_cast<std::int64_t>(seconds * 1e9);
    for (auto& c : connections_)
        ask(c);
    std::size_t open = connections_.size();
    std::int64_t last = start;
    epoll_event events[128];
    while (open > 0 && fault_.empty()) {
        const int n = ::epoll_wait(poller_, events, 128, 2000);
        if (n == 0) {
            fault_ = "no answer for two seconds";
            break;
        }
        last = now_ns();
        for (int i = 0; i < n && fault_.empty(); ++i) {
            Connection& c = connections_[events[i].data.u64];
            if (!take(c)) continue;
            if (last < end) {
                ask(c);
            } else {
                --open;
            }
        }
    }
    if (!fault_.empty() || latencies_ns_.empty()) return result;
    result.good = true;
    result.answers = latencies_ns_.size();
    result.per_second = static_cast<double>(latencies_ns_.size()) / (static_cast<double>(last - start) * 1e-9);
    const auto at = latencies_ns_.begin() + static_cast<std::ptrdiff_t>(latencies_ns_.size() * 99 / 100);
    std::nth_element(latencies_ns_.begin(), at, latencies_ns_.end());
    result.p99_us = *at / 1000.0;
    return result;
}

}  // namespace axisgate::bench
