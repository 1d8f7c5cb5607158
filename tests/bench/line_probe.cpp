// The sockets of both ends, the drive's twin between them, the program as a child process, and the bare relay. Times are those of the
// kernel's time stamps and of clock_ns(). The program ends with this process.
#include "tests/bench/line_probe.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>

#include "gateway/runtime/threads.hpp"

namespace axisgate::bench {
namespace {
std::int64_t read_clock(clockid_t which) {
    timespec t{};
    ::clock_gettime(which, &t);
    return t.tv_sec * 1'000'000'000 + t.tv_nsec;
}
}  // namespace

std::int64_t clock_ns() { return read_clock(CLOCK_MONOTONIC); }

void give_up(const std::string& why) {
    std::fprintf(stderr, "benchmark: %s\n", why.c_str());
    std::exit(1);
}

void note_arrivals(int fd) {
    const int one = 1;
    ::setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &one, sizeof one);
}

ssize_t receive(int fd, std::span<std::uint8_t> into, std::int64_t& came_ns) {
    iovec part{into.data(), into.size()};
    alignas(cmsghdr) std::array<char, 256> notes;
    msghdr m{};
    m.msg_iov = &part;
    m.msg_iovlen = 1;
    m.msg_control = notes.data();
    m.msg_controllen = notes.size();
    const ssize_t n = ::recvmsg(fd, &m, MSG_DONTWAIT);
    if (n <= 0) return n;
    came_ns = clock_ns();
    for (const cmsghdr* c = CMSG_FIRSTHDR(&m); c; c = CMSG_NXTHDR(&m, const_cast<cmsghdr*>(c))) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SO_TIMESTAMPNS) continue;
        timespec t{};
        std::memcpy(&t, CMSG_DATA(c), sizeof t);
        came_ns = t.tv_sec * 1'000'000'000 + t.tv_nsec - (read_clock(CLOCK_REALTIME) - came_ns);
    }
    return n;
}

void wait_for(std::initializer_list<int> fds, int timeout_ms) {
    std::array<pollfd, 8> list{};
    nfds_t n = 0;
    for (const int fd : fds)
        list[n++] = {fd, POLLIN, 0};  // poll ignores negative descriptors
    (void)::poll(list.data(), n, timeout_ms);
}

int listening_socket(std::uint16_t& port) {
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t n = sizeof a;
    if (fd < 0 || ::bind(fd, reinterpret_cast<sockaddr*>(&a), sizeof a) != 0 || ::listen(fd, 4) != 0 ||
        ::getsockname(fd, reinterpret_cast<sockaddr*>(&a), &n) != 0) {
        give_up("cannot listen on the loopback");
    }
    port = ntohs(a.sin_port);
    return fd;
}
int connected_socket(std::uint16_t port) {
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    a.sin_port = htons(port);
    const int one = 1;
    if (fd < 0 || ::connect(fd, reinterpret_cast<sockaddr*>(&a), sizeof a) != 0)
        give_up("cannot connect to 127.0.0.1:" + std::to_string(port));
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
    ::fcntl(fd, F_SETFL, O_NONBLOCK);
    note_arrivals(fd);
    return fd;
}
void no_delay(int fd) {
    const int one = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
}

Drive::Drive(const FamilyEntry& e) {
    listener_ = listening_socket(port_);
    ::fcntl(listener_, F_SETFL, O_NONBLOCK);
    TwinSetup setup;
    setup.address = "5";
    setup.kind = LineKind::bytes;
    twin_ = e.family->make_twin(*e.catalogue, setup);
    Out out;
    twin_->power_on({}, at_ns(clock_ns()), out);
}
Drive::~Drive() {
    ::close(listener_);
    if (fd_ >= 0) ::close(fd_);
}
int Drive::timeout_ms() const {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(twin_->deadline() - at_ns(clock_ns()));
    return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 1000));
}
std::int64_t Drive::pump(const std::bitset<128>& expected) {
    if (fd_ < 0) {
        fd_ = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (fd_ >= 0) {
            no_delay(fd_);
            note_arrivals(fd_);
        }
    }
    if (fd_ < 0) return 0;
    std::array<std::uint8_t, 4096> buffer;
    std::int64_t came = 0;
    const ssize_t n = receive(fd_, buffer, came);
    const std::int64_t now = clock_ns();
    std::int64_t seen = 0;
    if (n > 0) {
        const std::span<const std::uint8_t> bytes(buffer.data(), static_cast<std::size_t>(n));
        framer_.push(
            bytes,
            [&](const uim342::UiCheck& c, const uim342::UiBytes&) {
                functions.set(c.message.function());
                if (!expected.test(c.message.function())) seen = came;
            },
            [](std::uint8_t) {});
        for_each_run(bytes, [&](const Frame& f) {
            Out out;
            twin_->on_frame(f, at_ns(now), out);
            send(out);
        });
    } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
        ::close(fd_);
        fd_ = -1;
    }
    while (twin_->deadline() <= at_ns(now)) {
        Out out;
        twin_->on_deadline(at_ns(now), out);
        send(out);
    }
    return seen;
}
void Drive::put(std::int32_t position) {
    put_ = position;
    left_at_ = 0;
    Out out;
    if (const auto fault = twin_->set_hand("position", std::int64_t{position}, at_ns(clock_ns()), out); !fault.empty()) give_up(fault);
    send(out);
}
void Drive::send(const Out& out) {
    std::array<std::uint8_t, sizeof put_> words{};
    std::memcpy(words.data(), &put_, sizeof put_);  // in the drive's byte order: the low byte first
    for (const auto& tx : out.frames) {
        const auto bytes = tx.frame.data();
        if (left_at_ == 0 && std::search(bytes.begin(), bytes.end(), words.begin(), words.end()) != bytes.end()) left_at_ = clock_ns();
        if (fd_ >= 0) (void)!::send(fd_, tx.frame.storage.data(), tx.frame.size, MSG_NOSIGNAL);
    }
}

Program::Program(const std::string& path, const std::string& folder, const std::string& site, const cpu_set_t& cpus,
                 const std::vector<std::string>& settings) {
    std::ofstream(folder + "/site.json") << site;
    std::vector<std::string> words{
        path, "serve", "--data", folder + "/data", "--site", folder + "/site.json", "--set", "log.level=warning"};
    for (const auto& s : settings) {
        words.push_back("--set");
        words.push_back(s);
    }
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) give_up("no pipe");
    pid_ = ::fork();
    if (pid_ == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // also if a benchmark gives up
        ::dup2(ends[1], 1);
        (void)::sched_setaffinity(0, sizeof cpus, &cpus);
        std::vector<char*> arguments;
        for (auto& w : words)
            arguments.push_back(w.data());
        arguments.push_back(nullptr);
        ::execv(path.c_str(), arguments.data());
        ::_exit(127);
    }
    ::close(ends[1]);
    ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
    out_ = ends[0];
}
Program::~Program() {
    ::kill(pid_, SIGTERM);
    int status = 0;
    for (int i = 0; i < 300; ++i) {
        if (::waitpid(pid_, &status, WNOHANG) != 0) {
            ::close(out_);
            return;
        }
        ::usleep(10'000);
    }
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, &status, 0);
    ::close(out_);
}
bool Program::ready() {
    char buffer[1024];
    const ssize_t n = ::read(out_, buffer, sizeof buffer);
    if (n > 0) output_.append(buffer, static_cast<std::size_t>(n));
    if (n == 0) give_up("the program ended: " + output_);
    const auto at = ("\n" + output_).rfind("\nready");
    return at != std::string::npos && output_.find('\n', at) != std::string::npos;
}
std::uint16_t Program::port(const std::string& door) const {
    const auto at = output_.find(door + "=", output_.rfind("ready"));
    const auto colon = at == std::string::npos ? at : output_.find(':', at);
    return colon == std::string::npos ? std::uint16_t{0} : static_cast<std::uint16_t>(std::atoi(output_.c_str() + colon + 1));
}

ModbusClient::~ModbusClient() { ::close(fd_); }
void ModbusClient::write(std::uint16_t address, std::initializer_list<std::uint16_t> values) {
    std::vector<std::uint8_t> b{0,
                                ++transaction_,
                                0,
                                0,
                                0,
                                static_cast<std::uint8_t>(7 + 2 * values.size()),
                                1,
                                16,
                                static_cast<std::uint8_t>(address >> 8),
                                static_cast<std::uint8_t>(address),
                                0,
                                static_cast<std::uint8_t>(values.size()),
                                static_cast<std::uint8_t>(2 * values.size())};
    for (const auto v : values) {
        b.push_back(static_cast<std::uint8_t>(v >> 8));
        b.push_back(static_cast<std::uint8_t>(v));
    }
    send(b);
}
void ModbusClient::read(std::uint16_t address, std::uint16_t count) {
    const std::array<std::uint8_t, 12> b{0,
                                         ++transaction_,
                                         0,
                                         0,
                                         0,
                                         6,
                                         1,
                                         3,
                                         static_cast<std::uint8_t>(address >> 8),
                                         static_cast<std::uint8_t>(address),
                                         static_cast<std::uint8_t>(count >> 8),
                                         static_cast<std::uint8_t>(count)};
    send(b);
}
void ModbusClient::send(std::span<const std::uint8_t> request) {
    answer_.clear();
    if (::send(fd_, request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size()))
        give_up("a Modbus request could not be sent");
}
std::int64_t ModbusClient::answered() {
    std::array<std::uint8_t, 300> buffer;
    std::int64_t at = 0;
    const ssize_t n = receive(fd_, buffer, at);
    if (n > 0) answer_.insert(answer_.end(), buffer.begin(), buffer.begin() + n);
    if (n == 0) give_up("the gateway closed the Modbus connection");
    if (answer_.size() < 9 || answer_.size() < 6u + answer_[5] || n < 0) return 0;
    if (answer_[7] & 0x80) give_up("Modbus exception " + std::to_string(answer_[8]));
    return at;
}

double Distribution::at(double share) {
    std::ranges::sort(us);
    return us[std::min(us.size() - 1, static_cast<std::size_t>(static_cast<double>(us.size()) * share))];
}

Relay::Relay(int cpu, bool sleeping) : sleeping_(sleeping) {
    std::uint16_t in_port = 0, out_port = 0;
    const int in = listening_socket(in_port), out = listening_socket(out_port);
    pid_ = ::fork();
    if (pid_ == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (sleeping) (void)go_first();  // as the program's threads do
        if (cpu >= 0) {
            cpu_set_t set;
            CPU_ZERO(&set);
            CPU_SET(static_cast<unsigned>(cpu), &set);
            (void)::sched_setaffinity(0, sizeof set, &set);
        }
        const int from = ::accept(in, nullptr, nullptr), to = ::accept(out, nullptr, nullptr);
        no_delay(to);
        const int ep = ::epoll_create1(0);
        epoll_event e{};
        e.events = EPOLLIN;
        ::epoll_ctl(ep, EPOLL_CTL_ADD, from, &e);
        std::uint8_t buffer[512];
        while (::epoll_wait(ep, &e, 1, -1) == 1) {
            const ssize_t n = ::recv(from, buffer, sizeof buffer, 0);
            if (n <= 0) break;
            (void)!::send(to, buffer, 16, MSG_NOSIGNAL);
        }
        ::_exit(0);
    }
    in_ = connected_socket(in_port);
    out_ = connected_socket(out_port);
    ::close(in);
    ::close(out);
}
Relay::~Relay() {
    ::close(in_);
    ::close(out_);
    int status = 0;
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, &status, 0);
}
double Relay::once_us() {
    std::uint8_t buffer[64] = {};
    const std::int64_t begun = clock_ns();
    (void)!::send(in_, buffer, 17, MSG_NOSIGNAL);
    std::int64_t came = 0;
    while (receive(out_, buffer, came) <= 0) {
        if (clock_ns() - begun > 5'000'000'000) give_up("the relay does not answer");
        if (sleeping_) wait_for({out_}, 1000);
    }
    return static_cast<double>(came - begun) * 1e-3;
}

Distribution relay(int count, int cpu, std::int64_t pause_ns) {
    Relay relay(cpu, false);
    std::mt19937 random(1);
    Distribution d;
    for (int i = 0; i < count; ++i) {
        const std::int64_t begun = clock_ns();
        d.us.push_back(relay.once_us());
        const std::int64_t next =
            begun + pause_ns + (pause_ns ? static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(4 * pause_ns)) : 0);
        while (clock_ns() < next) {
        }
    }
    return d;
}

}  // namespace axisgate::bench
