// The EtherNet/IP originator of the benchmark: one session for questions, one socket for implicit data, on plain sockets without code of
// the gateway. Images have the kernel's time stamp. A fault ends the benchmark with its reason.
#pragma once

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "tests/bench/line_probe.hpp"
#include "tests/bench/modbus_load.hpp"

namespace axisgate::bench {
using Bytes = std::vector<std::uint8_t>;

inline std::int64_t real_ns() {
    timespec t{};
    (void)::clock_gettime(CLOCK_REALTIME, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}
inline void keep_on(int cpu) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(cpu), &set);
    (void)::sched_setaffinity(0, sizeof set, &set);
}
inline void put(Bytes& to, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
        to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
inline std::uint32_t number(const std::uint8_t* at, int bytes) {
    std::uint32_t n = 0;
    for (int i = bytes; i-- > 0;)
        n = n << 8 | at[i];
    return n;
}
inline sockaddr_in at(Address a) {
    sockaddr_in s{};
    s.sin_family = AF_INET;
    s.sin_addr.s_addr = htonl(a.host);
    s.sin_port = htons(a.port);
    return s;
}
inline int connected(Address a) {
    const int fd = ::socket(AF_INET, SOCK_STREAM, 0), on = 1;
    const sockaddr_in s = at(a);
    if (fd < 0 || ::connect(fd, reinterpret_cast<const sockaddr*>(&s), sizeof s) != 0) give_up("cannot connect");
    (void)::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return fd;
}
inline void read_whole(int fd, std::uint8_t* into, std::size_t n) {
    while (n > 0) {
        const auto got = ::recv(fd, into, n, 0);
        if (got <= 0) give_up("the other end has closed");
        into += got;
        n -= static_cast<std::size_t>(got);
    }
}
inline Bytes packet(std::uint16_t command, std::uint32_t session, const Bytes& data) {
    Bytes p;
    put(p, command, 2);
    put(p, data.size(), 2);
    put(p, session, 4);
    p.resize(24);
    p.insert(p.end(), data.begin(), data.end());
    return p;
}
/// An unconnected message, followed by further items.
inline Bytes message(std::uint8_t service, const Bytes& path, const Bytes& data, const Bytes& items = {}) {
    Bytes b;
    put(b, 0, 6);
    put(b, items.empty() ? 2 : 3, 2);
    put(b, 0, 4);
    put(b, 0xB2, 2);
    put(b, 2 + path.size() + data.size(), 2);
    put(b, service, 1);
    put(b, path.size() / 2, 1);
    for (const Bytes* part : {&path, &data, &items})
        b.insert(b.end(), part->begin(), part->end());
    return b;
}

class Session {
public:
    explicit Session(Address a) : fd_(connected(a)) {
        Bytes version;
        put(version, 1, 4);
        handle_ = number(exchange(0x65, version).data() + 4, 4);
    }
    ~Session() { ::close(fd_); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
    [[nodiscard]] int fd() const noexcept { return fd_; }
    [[nodiscard]] Bytes get_assembly() const { return packet(0x6F, handle_, message(0x0E, {0x20, 4, 0x24, 101, 0x30, 3}, {})); }
    Bytes exchange(std::uint16_t command, const Bytes& data) {
        const Bytes p = packet(command, handle_, data);
        if (::send(fd_, p.data(), p.size(), 0) != static_cast<ssize_t>(p.size())) give_up("cannot send");
        Bytes answer(24);
        read_whole(fd_, answer.data(), 24);
        answer.resize(24 + number(answer.data() + 2, 2));
        read_whole(fd_, answer.data() + 24, answer.size() - 24);
        return answer;
    }
    /// Class 1, point to point; returns the connection id of the device.
    std::uint32_t open(std::uint16_t serial, std::uint8_t output, std::uint8_t input, std::uint32_t ot_us, std::uint32_t to_us,
                       std::uint16_t ot_size, std::uint8_t multiplier, std::uint16_t our_port) {
        Bytes d{10, 14}, items;
        put(d, 0, 4);
        put(d, serial, 4);
        put(d, serial, 2);
        put(d, 0x4242, 2);
        put(d, 99, 4);
        put(d, multiplier, 4);
        put(d, ot_us, 4);
        put(d, 0x4800u | ot_size, 2);
        put(d, to_us, 4);
        put(d, 0x4800u | 34, 2);
        put(d, 0x0401, 2);
        const Bytes path{0x20, 4, 0x24, 199, 0x2C, output, 0x2C, input};
        d.insert(d.end(), path.begin(), path.end());
        put(items, 0x8001, 2);
        put(items, 16, 2);
        for (const std::uint16_t big : {std::uint16_t{2}, our_port}) {
            put(items, big >> 8, 1);
            put(items, big & 0xFF, 1);
        }
        put(items, 0, 8);
        put(items, 0, 4);
        const Bytes answer = exchange(0x6F, message(0x54, {0x20, 6, 0x24, 1}, d, items));
        if (answer.size() < 48 || answer[42] != 0) give_up("Forward_Open was refused");
        return number(answer.data() + 44, 4);
    }

private:
    int fd_;
    std::uint32_t handle_ = 0;
};

class Implicit {
public:
    explicit Implicit(Address device) : fd_(::socket(AF_INET, SOCK_DGRAM, 0)), device_(at(device)) {
        Address any;
        sockaddr_in s = at(any);
        socklen_t n = sizeof s;
        const int on = 1, room = 1 << 22;
        if (::bind(fd_, reinterpret_cast<sockaddr*>(&s), n) != 0) give_up("no UDP port");
        (void)::getsockname(fd_, reinterpret_cast<sockaddr*>(&s), &n);
        port_ = ntohs(s.sin_port);
        (void)::setsockopt(fd_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
        (void)::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    }
    ~Implicit() { ::close(fd_); }
    Implicit(const Implicit&) = delete;
    Implicit& operator=(const Implicit&) = delete;
    [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
    /// `output`: 32 bytes, or none for a heartbeat.
    void send(std::uint32_t id, std::uint32_t sequence, const Bytes& output) {
        Bytes d;
        put(d, 2, 2);
        put(d, 0x8002, 2);
        put(d, 8, 2);
        put(d, id, 4);
        put(d, sequence, 4);
        put(d, 0xB1, 2);
        put(d, output.empty() ? 2 : 6 + output.size(), 2);
        put(d, sequence & 0xFFFF, 2);
        if (!output.empty()) put(d, 1, 4);
        d.insert(d.end(), output.begin(), output.end());
        (void)::sendto(fd_, d.data(), d.size(), 0, reinterpret_cast<const sockaddr*>(&device_), sizeof device_);
    }
    struct Arrival {
        std::uint32_t id = 0;
        std::int64_t at_ns = 0;
        std::array<std::uint8_t, 32> input{};
    };
    /// Waits until `until_ns` at most. Returns false if nothing came.
    bool receive(Arrival& a, std::int64_t until_ns) {
        for (;;) {
            std::array<std::uint8_t, 256> bytes;
            alignas(cmsghdr) std::array<char, 128> control;
            iovec place{bytes.data(), bytes.size()};
            msghdr m{};
            m.msg_iov = &place;
            m.msg_iovlen = 1;
            m.msg_control = control.data();
            m.msg_controllen = control.size();
            const auto n = ::recvmsg(fd_, &m, MSG_DONTWAIT);
            if (n == 52) {
                a.id = number(bytes.data() + 6, 4);
                std::copy_n(bytes.begin() + 20, 32, a.input.begin());
                for (cmsghdr* c = CMSG_FIRSTHDR(&m); c; c = CMSG_NXTHDR(&m, c)) {
                    if (c->cmsg_type != SCM_TIMESTAMPNS) continue;
                    timespec t{};
                    std::memcpy(&t, CMSG_DATA(c), sizeof t);
                    a.at_ns = std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
                }
                return true;
            }
            const std::int64_t left = until_ns - real_ns();
            if (left <= 0) return false;
            pollfd p{fd_, POLLIN, 0};
            const timespec wait{left / 1'000'000'000, left % 1'000'000'000};
            (void)::ppoll(&p, 1, &wait, nullptr);
        }
    }

private:
    int fd_;
    sockaddr_in device_;
    std::uint16_t port_ = 0;
};

}  // namespace axisgate::bench
