// One epoll loop; answers must come in the order of their requests. A wrong answer or an exception ends the run.
#include "tests/bench/modbus_load.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

namespace axisgate::bench {
namespace {
std::int64_t now_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int connect_to(Address address) {
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
    ::fcntl(fd, F_SETFL, O_NONBLOCK);
    return fd;
}
}  // namespace

bool parse_address(const std::string& text, Address& out) {
    const auto colon = text.rfind(':');
    if (colon == std::string::npos) return false;
    in_addr host{};
    const std::string name = text.substr(0, colon) == "localhost" ? "127.0.0.1" : text.substr(0, colon);
    if (::inet_pton(AF_INET, name.c_str(), &host) != 1) return false;
    const int port = std::atoi(text.c_str() + colon + 1);
    if (port < 1 || port > 65535) return false;
    out = {ntohl(host.s_addr), static_cast<std::uint16_t>(port)};
    return true;
}

Load::Load(Address address, int connections, int in_flight, std::uint16_t registers)
    : poller_(::epoll_create1(0)), in_flight_(in_flight), registers_(registers), answer_size_(9 + 2 * std::size_t{registers}) {
    connections_.resize(static_cast<std::size_t>(connections));
    latencies_ns_.reserve(1u << 20);
    for (std::size_t i = 0; i < connections_.size(); ++i) {
        Connection& c = connections_[i];
        c.fd = connect_to(address);
        if (c.fd < 0) fault_ = std::string("cannot connect: ") + std::strerror(errno);
        c.sent_at.resize(64);
        c.in.resize(answer_size_ * 64);
        epoll_event e{};
        e.events = EPOLLIN;
        e.data.u64 = i;
        ::epoll_ctl(poller_, EPOLL_CTL_ADD, c.fd, &e);
    }
}

Load::~Load() {
    for (auto& c : connections_) {
        if (c.fd >= 0) ::close(c.fd);
    }
    ::close(poller_);
}

void Load::ask(Connection& c, int requests) {
    std::uint8_t out[64 * 12];
    const std::int64_t at = now_ns();
    for (int i = 0; i < requests; ++i) {
        const std::uint8_t request[12] = {
            static_cast<std::uint8_t>(c.next >> 8),     static_cast<std::uint8_t>(c.next),    0, 0, 0, 6, 1, 3, 0, 0,
            static_cast<std::uint8_t>(registers_ >> 8), static_cast<std::uint8_t>(registers_)};
        std::memcpy(out + 12 * i, request, sizeof request);
        c.sent_at[c.next % c.sent_at.size()] = at;
        ++c.next;
    }
    const auto size = static_cast<std::size_t>(12 * requests);
    if (::send(c.fd, out, size, MSG_NOSIGNAL) != static_cast<ssize_t>(size)) fault_ = std::string("cannot send: ") + std::strerror(errno);
}

int Load::take(Connection& c) {
    const auto r = ::recv(c.fd, c.in.data() + c.have, c.in.size() - c.have, 0);
    if (r <= 0) {
        if (r < 0 && errno == EAGAIN) return 0;
        fault_ = "the server closed a connection";
        return -1;
    }
    c.have += static_cast<std::size_t>(r);
    const std::int64_t at = now_ns();
    std::size_t begin = 0;
    int taken = 0;
    for (; c.have - begin >= answer_size_; begin += answer_size_, ++taken) {
        const std::uint8_t* a = c.in.data() + begin;
        const auto transaction = static_cast<std::uint16_t>((a[0] << 8) | a[1]);
        if (transaction != c.expected || a[7] != 3 || a[8] != 2 * registers_) {
            fault_ = "a wrong answer (function " + std::to_string(int{a[7]}) + ", byte " + std::to_string(int{a[8]}) + ")";
            return -1;
        }
        latencies_ns_.push_back(
            static_cast<std::uint32_t>(std::min<std::int64_t>(at - c.sent_at[transaction % c.sent_at.size()], UINT32_MAX)));
        ++c.expected;
    }
    // An exception is shorter than an answer, so it is reported instead of waiting for more bytes.
    if (c.have - begin >= 9 && (c.in[begin + 7] & 0x80) != 0) {
        fault_ = "exception " + std::to_string(int{c.in[begin + 8]}) + " (are axes 1 and 2 configured?)";
        return -1;
    }
    if (begin > 0) std::memmove(c.in.data(), c.in.data() + begin, c.have - begin);
    c.have -= begin;
    return taken;
}

LoadResult Load::run(double seconds) {
    LoadResult result;
    if (!fault_.empty()) return result;
    latencies_ns_.clear();
    const std::int64_t start = now_ns();
    const std::int64_t end = start + static_cast<std::int64_t>(seconds * 1e9);
    for (auto& c : connections_)
        ask(c, in_flight_);
    std::size_t open = connections_.size() * static_cast<std::size_t>(in_flight_);
    std::int64_t last = start;
    epoll_event events[128];
    while (open > 0 && fault_.empty()) {
        const int n = ::epoll_wait(poller_, events, 128, never_sleeps_ ? 0 : 2000);
        if (n == 0 && never_sleeps_ && now_ns() - last < 2'000'000'000) continue;
        if (n == 0) {
            fault_ = "no answer for two seconds";
            break;
        }
        last = now_ns();
        for (int i = 0; i < n; ++i) {
            Connection& c = connections_[events[i].data.u64];
            const int taken = take(c);
            if (taken < 0) break;
            open -= static_cast<std::size_t>(taken);
            if (taken > 0 && last < end) {
                ask(c, taken);
                open += static_cast<std::size_t>(taken);
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

IdleConnections::IdleConnections(Address address, int count) : all_(true) {
    for (int i = 0; i < count; ++i) {
        fds_.push_back(connect_to(address));
        all_ = all_ && fds_.back() >= 0;
    }
    ::usleep(20'000);  // the server accepts them before the measurement begins
}
IdleConnections::~IdleConnections() {
    for (const int fd : fds_) {
        if (fd >= 0) ::close(fd);
    }
    ::usleep(20'000);
}
bool IdleConnections::good() const {
    return all_ && std::none_of(fds_.begin(), fds_.end(), [](int fd) {
               char byte;
               return ::recv(fd, &byte, 1, 0) >= 0 || errno != EAGAIN;
           });
}

}  // namespace axisgate::bench
