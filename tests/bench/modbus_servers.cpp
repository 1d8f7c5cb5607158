// The door over a port without an engine, whose pictures its loop changes; and the epoll server. One thread each.
#include "tests/bench/modbus_servers.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <sched.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "gateway/doors/modbus/server.hpp"
#include "gateway/engine/door.hpp"

namespace axisgate::bench {

void pin(int cpu) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(cpu), &set);
    (void)::pthread_setaffinity_np(::pthread_self(), sizeof set, &set);
}

double processor_seconds(std::thread& thread) {
    clockid_t clock{};
    timespec t{};
    if (::pthread_getcpuclockid(thread.native_handle(), &clock) != 0 || ::clock_gettime(clock, &t) != 0) return 0;
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

namespace {
constexpr std::uint16_t axes = 8;

/// Axes without drives, with the machine's clock.
struct MovingPort final : DoorPort {
    MovingPort() {
        if (!image_.grow(axes)) std::abort();
        std::vector<AxisId> numbers{no_axis};
        for (std::uint16_t i = 0; i < axes; ++i) {
            numbers.push_back(AxisId{i});
            image_.picture(AxisId{i}).number = static_cast<std::uint16_t>(i + 1);
            image_.picture(AxisId{i}).ever_seen = true;
        }
        image_.set_numbers(std::move(numbers));
        move();
    }
    void move() {
        for (std::uint16_t i = 0; i < axes; ++i) {
            AxisPicture& p = image_.picture(AxisId{i});
            p.position += 17 * (i + 1);
            p.velocity = 17000 * (i + 1);
            p.statusword = 0x0227;
            p.flags = flag_online | flag_moving;
            p.at = now();
            image_.publish(AxisId{i});
        }
    }
    Instant now() const override {
        return at_ns(std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count());
    }
    const Image& image() const override { return image_; }
    const Catalogue* catalogue(AxisId) const override { return nullptr; }
    void submit(Command) override {}
    std::optional<Refusal> set_point(const SetPoint&) override { return std::nullopt; }
    DoorNumber attach(HotDoor&) override { return 1; }
    void detach(HotDoor&) override {}
    Image image_;
};
}  // namespace

struct DoorServer::State {
    boost::asio::io_context io{1};
    MovingPort port;
    registers::RegisterImage image{port, {}};
    modbus::Server server{io, port, image, {}};
    boost::asio::steady_timer timer{io};
    std::atomic<bool> stop{false};

    void tick() {
        timer.expires_after(std::chrono::milliseconds(1));
        timer.async_wait([this](boost::system::error_code ec) {
            if (ec) return;
            if (server.counters().connections_open.value() > 0) port.move();
            tick();
        });
    }
    void run(int spin_us) {
        using clock = std::chrono::steady_clock;
        auto quiet_since = clock::now();
        while (!stop) {
            if (io.poll() > 0) {
                quiet_since = clock::now();
            } else if (spin_us == 0 || clock::now() - quiet_since > std::chrono::microseconds(spin_us)) {
                if (io.run_one() == 0) return;
                quiet_since = clock::now();
            }
        }
    }
};

DoorServer::DoorServer(int cpu, int spin_us) : state_(std::make_unique<State>()) {
    const std::string bind = "127.0.0.1:0";
    if (const auto fault = state_->server.open(std::span(&bind, 1)); !fault.empty()) {
        std::fprintf(stderr, "%s\n", fault.c_str());
        std::exit(1);
    }
    const auto text = state_->server.addresses().at(0);
    address_.port = static_cast<std::uint16_t>(std::stoi(text.substr(text.rfind(':') + 1)));
    state_->tick();
    thread_ = std::thread([this, cpu, spin_us] {
        pin(cpu);
        if (spin_us == 0) {
            state_->io.run();
        } else {
            state_->run(spin_us);
        }
    });
}

DoorServer::~DoorServer() {
    state_->stop = true;
    state_->io.stop();
    thread_.join();
}

namespace {
struct Peer {
    int fd = -1;
    std::size_t have = 0;
    std::array<std::uint8_t, 8192> in;
};
}  // namespace

PlainServer::PlainServer(int cpu) {
    listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
    stop_ = ::eventfd(0, EFD_NONBLOCK);
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t n = sizeof a;
    if (::bind(listening_, reinterpret_cast<sockaddr*>(&a), sizeof a) != 0 || ::listen(listening_, 1024) != 0 ||
        ::getsockname(listening_, reinterpret_cast<sockaddr*>(&a), &n) != 0) {
        std::perror("the plain server cannot listen");
        std::exit(1);
    }
    address_.port = ntohs(a.sin_port);
    thread_ = std::thread([this, cpu] {
        pin(cpu);
        serve();
    });
}

PlainServer::~PlainServer() {
    const std::uint64_t one = 1;
    (void)!::write(stop_, &one, sizeof one);
    thread_.join();
    ::close(listening_);
    ::close(stop_);
}

void PlainServer::serve() {
    const int poller = ::epoll_create1(0);
    const auto add = [&](int fd, void* what) {
        epoll_event e{};
        e.events = EPOLLIN;
        e.data.ptr = what;
        ::epoll_ctl(poller, EPOLL_CTL_ADD, fd, &e);
    };
    add(listening_, &listening_);
    add(stop_, &stop_);
    std::vector<std::uint8_t> out(8192 / 12 * 260);
    epoll_event events[128];
    std::vector<std::unique_ptr<Peer>> peers;
    for (bool going = true; going;) {
        const int n = ::epoll_wait(poller, events, 128, -1);
        for (int i = 0; i < n; ++i) {
            if (events[i].data.ptr == &stop_) {
                going = false;
                continue;
            }
            if (events[i].data.ptr == &listening_) {
                for (int fd; (fd = ::accept4(listening_, nullptr, nullptr, SOCK_NONBLOCK)) >= 0;) {
                    const int on = 1;
                    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
                    peers.push_back(std::make_unique<Peer>());
                    peers.back()->fd = fd;
                    add(fd, peers.back().get());
                }
                continue;
            }
            Peer& p = *static_cast<Peer*>(events[i].data.ptr);
            const auto r = ::recv(p.fd, p.in.data() + p.have, p.in.size() - p.have, 0);
            if (r <= 0) {
                ::close(p.fd);
                p.fd = -1;
                continue;
            }
            p.have += static_cast<std::size_t>(r);
            const std::size_t data = 2 * std::size_t{registers_.load(std::memory_order_relaxed)};
            std::size_t at = 0;
            std::size_t size = 0;
            for (; p.have - at >= 12; at += 12) {
                std::uint8_t* const answer = out.data() + size;
                std::memcpy(answer, p.in.data() + at, 8);
                answer[4] = static_cast<std::uint8_t>((data + 3) >> 8);
                answer[5] = static_cast<std::uint8_t>(data + 3);
                answer[8] = static_cast<std::uint8_t>(data);
                size += 9 + data;
            }
            if (at < p.have) std::memmove(p.in.data(), p.in.data() + at, p.have - at);
            p.have -= at;
            if (size > 0) (void)!::send(p.fd, out.data(), size, MSG_NOSIGNAL);
        }
        std::erase_if(peers, [](const auto& p) { return p->fd < 0; });
    }
    for (const auto& p : peers)
        ::close(p->fd);
    ::close(poller);
}

}  // namespace axisgate::bench
