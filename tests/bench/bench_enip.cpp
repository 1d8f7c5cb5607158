// The EtherNet/IP benchmark measures explicit messages against a plain echo of the same sizes, the jitter of implicit data, the time from
// an output to the drive's line, and the stop when an owner falls silent. For each figure it prints the ratio, its limit and both figures;
// exit 1 if a limit is exceeded. It uses plain sockets, and the kernel's time stamps of received data, so that its own wake-up time is not
// measured.
#include <netinet/tcp.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "gateway/runtime/threads.hpp"
#include "tests/bench/enip_originator.hpp"
#include "tests/bench/enip_output.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {
namespace {
// --- explicit messages

/// epoll, recv and one send per request, on the processor and with the rank of the gateway's hot thread: the fastest possible server that
/// still answers.
class Echo {
public:
    Echo(std::size_t request, std::size_t answer) : request_(request), answer_(answer), listening_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in s = at(address_);
        socklen_t n = sizeof s;
        if (::bind(listening_, reinterpret_cast<sockaddr*>(&s), n) != 0 || ::listen(listening_, 128) != 0) give_up("cannot listen");
        (void)::getsockname(listening_, reinterpret_cast<sockaddr*>(&s), &n);
        address_.port = ntohs(s.sin_port);
        thread_ = std::thread([this] { serve(); });
    }
    ~Echo() {
        stop_ = true;
        thread_.join();
        ::close(listening_);
    }
    Echo(const Echo&) = delete;
    Echo& operator=(const Echo&) = delete;
    [[nodiscard]] Address address() const noexcept { return address_; }

private:
    void serve() {
        keep_on(0);
        if (!go_first()) take_short_turns(hot_turn_ns);
        const int poller = ::epoll_create1(0), on = 1;
        const auto watch = [&](int fd) {
            epoll_event e{};
            e.events = EPOLLIN;
            e.data.fd = fd;
            (void)::epoll_ctl(poller, EPOLL_CTL_ADD, fd, &e);
        };
        watch(listening_);
        Bytes in(4096);
        const Bytes out(answer_);
        std::array<epoll_event, 64> events{};
        while (!stop_) {
            const int n = ::epoll_wait(poller, events.data(), static_cast<int>(events.size()), 50);
            for (int i = 0; i < n; ++i) {
                const int fd = events[static_cast<std::size_t>(i)].data.fd;
                if (fd == listening_) {
                    const int peer = ::accept(fd, nullptr, nullptr);
                    (void)::setsockopt(peer, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
                    watch(peer);
                } else if (const auto got = ::recv(fd, in.data(), in.size(), 0); got <= 0) {
                    ::close(fd);
                } else if (static_cast<std::size_t>(got) != request_ || ::send(fd, out.data(), out.size(), MSG_NOSIGNAL) < 0) {
                    give_up("a request came in pieces");
                }
            }
        }
        ::close(poller);
    }
    std::size_t request_, answer_;
    Address address_;
    int listening_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

/// Answers per second, with one request in progress on each connection.
double rate(const std::vector<int>& fds, const std::vector<Bytes>& requests, std::size_t answer, double seconds) {
    const int poller = ::epoll_create1(0);
    std::vector<std::size_t> have(fds.size());
    const auto ask = [&](std::size_t i) {
        if (::send(fds[i], requests[i].data(), requests[i].size(), MSG_NOSIGNAL) != static_cast<ssize_t>(requests[i].size()))
            give_up("cannot send");
    };
    for (std::size_t i = 0; i < fds.size(); ++i) {
        epoll_event e{};
        e.events = EPOLLIN;
        e.data.u64 = i;
        (void)::epoll_ctl(poller, EPOLL_CTL_ADD, fds[i], &e);
        ask(i);
    }
    const std::int64_t begun = real_ns(), end = begun + static_cast<std::int64_t>(seconds * 1e9);
    std::size_t answers = 0, open = fds.size();
    std::int64_t now = begun;
    Bytes in(4096);
    std::array<epoll_event, 64> events{};
    while (open > 0) {
        const int n = ::epoll_wait(poller, events.data(), static_cast<int>(events.size()), 2000);
        if (n <= 0) give_up("no answer within two seconds");
        now = real_ns();
        for (int k = 0; k < n; ++k) {
            const std::size_t i = events[static_cast<std::size_t>(k)].data.u64;
            const auto got = ::recv(fds[i], in.data(), in.size(), 0);
            if (got <= 0) give_up("the other end has closed");
            have[i] += static_cast<std::size_t>(got);
            if (have[i] < answer) continue;
            if (have[i] > answer) give_up("an answer has another size");
            have[i] = 0;
            ++answers;
            now < end ? ask(i) : static_cast<void>(--open);
        }
    }
    ::close(poller);
    return static_cast<double>(answers) * 1e9 / static_cast<double>(now - begun);
}

/// The gateway is paused while the echo answers, and the echo while the gateway does, so that each has the processor for itself.
class Paused {
public:
    explicit Paused(pid_t program) : program_(program) {
        if (program_ > 0) (void)::kill(program_, SIGSTOP);
    }
    ~Paused() {
        if (program_ > 0) (void)::kill(program_, SIGCONT);
    }
    Paused(const Paused&) = delete;
    Paused& operator=(const Paused&) = delete;

private:
    pid_t program_;
};

/// `pid` is that of the program; 0: it keeps running beside the echo, which makes the ratio too good. `only`: this number of sessions; 0:
/// all three figures.
bool explicit_messages(Address program, pid_t pid, int only) {
    constexpr double least = 0.9;
    constexpr int slices = 7;
    bool kept = true;
    for (const int count : {1, 8, 64}) {
        if (only != 0 && only != count) continue;
        std::vector<std::unique_ptr<Session>> sessions;
        std::vector<int> ours, theirs;
        std::vector<Bytes> requests;
        for (int i = 0; i < count; ++i) {
            sessions.push_back(std::make_unique<Session>(program));
            ours.push_back(sessions.back()->fd());
            requests.push_back(sessions.back()->get_assembly());
        }
        if (::send(ours[0], requests[0].data(), requests[0].size(), 0) < 0) give_up("cannot send");
        Bytes head(24);
        read_whole(ours[0], head.data(), 24);
        Bytes rest(number(head.data() + 2, 2));
        read_whole(ours[0], rest.data(), rest.size());
        const std::size_t answer = 24 + rest.size();
        if (answer != 24 + 6 + 10 + 4 + 32 || rest[18] != 0) give_up("the assembly is not read");
        Echo echo(requests[0].size(), answer);
        for (int i = 0; i < count; ++i)
            theirs.push_back(connected(echo.address()));
        std::vector<double> ratio, a, b;
        const auto of_echo = [&](double seconds) {
            const Paused gateway(pid);
            return rate(theirs, requests, answer, seconds);
        };
        (void)rate(ours, requests, answer, 0.1);
        (void)of_echo(0.1);
        for (int i = 0; i < slices; ++i) {
            const bool first = i % 2 == 0;
            if (first) a.push_back(rate(ours, requests, answer, 0.3));
            b.push_back(of_echo(0.3));
            if (!first) a.push_back(rate(ours, requests, answer, 0.3));
            ratio.push_back(a.back() / b.back());
        }
        for (auto* list : {&ratio, &a, &b})
            std::ranges::sort(*list);
        const std::string what = "explicit, " + std::to_string(count) + (count == 1 ? " session" : " sessions");
        kept &= say(what.c_str(), ratio[slices / 2], ">=", least, "axisgate", a[slices / 2], "echo", b[slices / 2], "/s");
        for (const int fd : theirs)
            ::close(fd);
    }
    return kept;
}

// --- implicit data

double share(std::vector<double>& v, double of) {
    const auto at_most = static_cast<std::size_t>(of * static_cast<double>(v.size() - 1));
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(at_most), v.end());
    return v[at_most];
}

/// 32 owners at 2 ms, and during half of the time Modbus clients at their full rate.
bool jitter(Address program, Address io, Address modbus, double seconds) {
    constexpr std::uint32_t count = 32, rpi_us = 2000;
    constexpr double p99_us = 300, p9999_us = 2000;
    Session session(program);
    Implicit udp(io);
    std::vector<std::uint32_t> ids;
    for (std::uint32_t i = 1; i <= count; ++i)
        ids.push_back(session.open(static_cast<std::uint16_t>(i), static_cast<std::uint8_t>(150 + i), static_cast<std::uint8_t>(100 + i),
                                   rpi_us, rpi_us, 38, 5, udp.port()));
    std::atomic<bool> stop{false};
    std::size_t answered = 0;
    std::thread clients([&] {
        Load load(modbus, 8, 1, 10);
        while (!stop) {
            const LoadResult r = load.run(0.002);
            if (!r.good) give_up("Modbus: " + load.fault());
            answered += r.answers;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    });
    const Bytes idle_output(32);
    std::vector<std::int64_t> last(count + 1);
    std::vector<double> off_us;
    const std::int64_t begun = real_ns(), warm = begun + 500'000'000, end = warm + static_cast<std::int64_t>(seconds * 1e9);
    std::int64_t due = begun;
    for (std::uint32_t sequence = 1; real_ns() < end;) {
        if (real_ns() >= due) {
            for (const std::uint32_t id : ids)
                udp.send(id, sequence, idle_output);
            ++sequence;
            due += rpi_us * 1000;
        }
        Implicit::Arrival a;
        if (!udp.receive(a, due)) continue;
        if (a.id == 0 || a.id > count) give_up("data of a connection that was not opened");
        if (last[a.id] != 0 && a.at_ns > warm) off_us.push_back(std::abs(static_cast<double>(a.at_ns - last[a.id]) / 1000 - rpi_us));
        last[a.id] = a.at_ns;
    }
    stop = true;
    clients.join();
    const double due_count = seconds * 1e6 / rpi_us * count;
    std::printf("    %zu intervals of %u connections, %.0f Modbus answers per second beside them\n", off_us.size(), count,
                static_cast<double>(answered) / (seconds + 0.5));
    if (off_us.empty()) give_up("nothing came");
    bool kept = say("intervals that came", static_cast<double>(off_us.size()) / due_count, ">=", 0.99, "axisgate",
                    static_cast<double>(off_us.size()), "due", due_count, "");
    const double p99 = share(off_us, 0.99), p9999 = share(off_us, 0.9999);
    kept &= say("jitter p99", p99 / p99_us, "<=", 1, "axisgate", p99, "limit", p99_us, "us");
    kept &= say("jitter p99.99", p9999 / p9999_us, "<=", 1, "axisgate", p9999, "limit", p9999_us, "us");
    return kept;
}

// --- an owner that falls silent

bool lost_owner(Address program, Address io) {
    constexpr std::uint32_t rpi_us = 10'000, watch_us = 1000;
    constexpr double limit_ms = rpi_us * 4 / 1000.0 + 2;
    Session session(program);
    Implicit udp(io);
    const std::uint32_t watcher = session.open(1, 198, 101, 1'000'000, watch_us, 2, 3, udp.port());
    std::vector<double> took_ms;
    std::uint32_t beats = 0;
    for (std::uint16_t round = 0; round < 20; ++round) {
        const auto serial = static_cast<std::uint16_t>(2 + round);
        const std::uint32_t owner = session.open(serial, 151, 101, rpi_us, rpi_us, 38, 0, udp.port());
        Bytes output(32);
        const auto want = [&](std::uint16_t word, std::int32_t speed) {
            output = Bytes();
            put(output, word, 2);
            put(output, 3, 2);
            for (const std::uint32_t v : {0u, 3200u, 32000u, 32000u, static_cast<std::uint32_t>(speed)})
                put(output, v, 4);
            output.resize(32);
        };
        want(0, 0);
        std::uint16_t word = 0;
        std::int64_t due = real_ns(), sent_at = 0;
        const std::int64_t patience = due + 10'000'000'000;
        bool moving = false;
        std::int64_t moves_since = 0;
        for (std::uint32_t sequence = 1; !moving || real_ns() < moves_since + 100'000'000;) {
            if (real_ns() > patience) give_up("the axis does not move");
            if (real_ns() >= due) {
                udp.send(watcher, ++beats, {});
                sent_at = real_ns();
                udp.send(owner, sequence++, output);
                due = sent_at + rpi_us * 1000;
            }
            Implicit::Arrival a;
            if (!udp.receive(a, due) || a.id != 1) continue;
            const std::uint32_t state = number(a.input.data(), 2) & 0x6F;
            const std::uint16_t next = state == 0x27            ? 0x0F
                                       : state == 0x23          ? 0x0F
                                       : state == 0x21          ? 0x07
                                       : (state & 0x4F) == 0x40 ? 0x06
                                                                : 0;
            if (next != word || state == 0x27) want(word = next, state == 0x27 ? 1600 : 0);
            if (!moving && state == 0x27 && number(a.input.data() + 8, 4) != 0) {
                moving = true;
                moves_since = real_ns();
            }
        }
        // The newest image was the last one.
        for (;;) {
            Implicit::Arrival a;
            if (!udp.receive(a, sent_at + 1'000'000'000)) give_up("the axis is not stopped");
            const bool stops = (number(a.input.data() + 18, 2) & 0x100) != 0;  // flag: fail-safe
            if (a.id != 1 || !stops || a.at_ns < sent_at) continue;
            took_ms.push_back(static_cast<double>(a.at_ns - sent_at) / 1e6);
            break;
        }
    }
    std::ranges::sort(took_ms);
    std::printf("    %zu losses: %.2f to %.2f ms from the last datagram to the first image that says so\n", took_ms.size(), took_ms.front(),
                took_ms.back());
    return say("stop of a lost owner, longest", took_ms.back() / limit_ms, "<=", 1, "axisgate", took_ms.back(), "RPI x 4 + 2 ms", limit_ms,
               "ms");
}
}  // namespace
}  // namespace axisgate::bench

int main(int argc, char** argv) {
    using namespace axisgate::bench;
    std::vector<std::string> arg(argv + 1, argv + argc);
    Address program, io, modbus;
    const auto usage = [] {
        std::fputs(
            "usage: bench_enip output PROGRAM [COUNT] | explicit HOST:PORT [PID [SESSIONS]] | jitter HOST:PORT HOST:IO_PORT "
            "MODBUS_HOST:PORT "
            "[SECONDS] | lost HOST:PORT HOST:IO_PORT\n",
            stderr);
        return 2;
    };
    if (arg.size() >= 2 && arg[0] == "output") return output_to_frame(arg[1], arg.size() > 2 ? std::atoi(arg[2].c_str()) : 4000) ? 0 : 1;
    if (arg.size() < 2 || !parse_address(arg[1], program)) return usage();
    keep_on(1);
    const auto number_at = [&](std::size_t i) { return arg.size() > i ? std::atoi(arg[i].c_str()) : 0; };
    if (arg[0] == "explicit") return explicit_messages(program, number_at(2), number_at(3)) ? 0 : 1;
    if (arg.size() < 3 || !parse_address(arg[2], io)) return usage();
    if (arg[0] == "lost") return lost_owner(program, io) ? 0 : 1;
    if (arg[0] != "jitter" || arg.size() < 4 || !parse_address(arg[3], modbus)) return usage();
    return jitter(program, io, modbus, arg.size() > 4 ? std::atof(arg[4].c_str()) : 10) ? 0 : 1;
}
