// Write benchmark: the real program, from a Modbus write to the frame that it causes on the drive's line.
// In: the program's path. Out: the distribution, the limit for the 99th percentile, and beside it what a bare relay needs on this machine
// in the same run; exit 1 if the limit is not kept.
// One thread is Modbus client and drive at once: it notes the time before the write leaves and the time at which the frame is there.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "adapters/uim342/wire_uimessage.hpp"
#include "gateway/core/assets.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/family.hpp"
#include "gateway/site/site.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {
namespace {

std::int64_t clock_ns() {
    timespec t{};
    ::clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * 1'000'000'000 + t.tv_nsec;
}

[[noreturn]] void give_up(const std::string& why) {
    std::fprintf(stderr, "bench_write: %s\n", why.c_str());
    std::exit(1);
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
    return fd;
}
void no_delay(int fd) {
    const int one = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
}

/// The drive at the end of the line: the family's twin, answering at once.
class Drive {
public:
    explicit Drive(const FamilyEntry& e) {
        listener_ = listening_socket(port_);
        ::fcntl(listener_, F_SETFL, O_NONBLOCK);
        TwinSetup setup;
        setup.address = "5";
        setup.kind = LineKind::bytes;
        twin_ = e.family->make_twin(*e.catalogue, setup);
        Out out;
        twin_->power_on({}, at_ns(clock_ns()), out);
    }
    ~Drive() {
        ::close(listener_);
        if (fd_ >= 0) ::close(fd_);
    }
    [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

    /// Does what there is to do; never waits. Returns the instant at which a frame was there whose function is not in `expected`, else 0.
    std::int64_t pump(const std::bitset<128>& expected) {
        if (fd_ < 0) {
            fd_ = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
            if (fd_ >= 0) no_delay(fd_);
        }
        if (fd_ < 0) return 0;
        std::array<std::uint8_t, 4096> buffer;
        const ssize_t n = ::recv(fd_, buffer.data(), buffer.size(), 0);
        const std::int64_t now = clock_ns();
        std::int64_t seen = 0;
        if (n > 0) {
            const std::span<const std::uint8_t> bytes(buffer.data(), static_cast<std::size_t>(n));
            framer_.push(
                bytes,
                [&](const uim342::UiCheck& c, const uim342::UiBytes&) {
                    functions.set(c.message.function());
                    if (!expected.test(c.message.function())) seen = now;
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
    std::bitset<128> functions;  ///< of the frames that came

private:
    void send(const Out& out) {
        for (const auto& tx : out.frames) {
            if (fd_ >= 0) (void)!::send(fd_, tx.frame.storage.data(), tx.frame.size, MSG_NOSIGNAL);
        }
    }
    int listener_ = -1, fd_ = -1;
    std::uint16_t port_ = 0;
    std::unique_ptr<Twin> twin_;
    uim342::UiFramer framer_;
};

/// The gateway as a process of its own.
class Program {
public:
    /// On the processors of `cpus`: the measuring thread never sleeps, and a thread that is put beside it would wait for the next tick.
    Program(const std::string& path, const std::string& folder, std::uint16_t drive_port, const cpu_set_t& cpus) {
        std::ofstream(folder + "/site.json")
            << R"({"lines":[{"name":"l","uri":"tcp:127.0.0.1:)" << drive_port
            << R"(","family":"uim342"}],"drives":[{"name":"d","line":"l","address":5,"presence":"device"}],)"
            << R"("axes":[{"name":"a","drive":"d","number":1}]})";
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) give_up("no pipe");
        pid_ = ::fork();
        if (pid_ == 0) {
            ::dup2(ends[1], 1);
            (void)::sched_setaffinity(0, sizeof cpus, &cpus);
            const std::string data = folder + "/data", site = folder + "/site.json";
            ::execl(path.c_str(), path.c_str(), "serve", "--data", data.c_str(), "--site", site.c_str(), "--set", "http.bind=off", "--set",
                    "modbus.bind=127.0.0.1:0", "--set", "log.level=warning", nullptr);
            ::_exit(127);
        }
        ::close(ends[1]);
        ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
        out_ = ends[0];
    }
    ~Program() {
        ::kill(pid_, SIGTERM);
        int status = 0;
        for (int i = 0; i < 300 && ::waitpid(pid_, &status, WNOHANG) == 0; ++i)
            ::usleep(10'000);
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, &status, 0);
        ::close(out_);
    }
    /// 0 until it is ready, then its Modbus port.
    std::uint16_t ready() {
        char buffer[1024];
        const ssize_t n = ::read(out_, buffer, sizeof buffer);
        if (n > 0) said_.append(buffer, static_cast<std::size_t>(n));
        if (n == 0) give_up("the program ended: " + said_);
        const auto at = said_.find("modbus=");
        if (said_.find("ready") == std::string::npos || at == std::string::npos || said_.find('\n', at) == std::string::npos) return 0;
        const auto colon = said_.find(':', at);
        return static_cast<std::uint16_t>(std::atoi(said_.c_str() + colon + 1));
    }

private:
    pid_t pid_ = -1;
    int out_ = -1;
    std::string said_;
};

/// A Modbus client that never waits by itself.
class Client {
public:
    explicit Client(std::uint16_t port) : fd_(connected_socket(port)) {}
    ~Client() { ::close(fd_); }
    void write(std::uint16_t address, std::initializer_list<std::uint16_t> values) {
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
        answer_.clear();
        if (::send(fd_, b.data(), b.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(b.size())) give_up("a Modbus write could not be sent");
    }
    /// The whole answer is there; an exception ends the benchmark.
    bool answered() {
        std::uint8_t buffer[300];
        const ssize_t n = ::recv(fd_, buffer, sizeof buffer, 0);
        if (n > 0) answer_.insert(answer_.end(), buffer, buffer + n);
        if (n == 0) give_up("the gateway closed the Modbus connection");
        if (answer_.size() < 9 || answer_.size() < 6u + answer_[5]) return false;
        if (answer_[7] & 0x80) give_up("Modbus exception " + std::to_string(answer_[8]));
        return true;
    }

private:
    int fd_;
    std::uint8_t transaction_ = 0;
    std::vector<std::uint8_t> answer_;
};

struct Distribution {
    std::vector<double> us;
    double at(double share) {
        std::ranges::sort(us);
        return us[std::min(us.size() - 1, static_cast<std::size_t>(static_cast<double>(us.size()) * share))];
    }
};

/// The least that any gateway needs: a process that sleeps until bytes come on one connection and writes them to another.
Distribution relay(int count, int cpu) {
    std::uint16_t in_port = 0, out_port = 0;
    const int in = listening_socket(in_port), out = listening_socket(out_port);
    const pid_t pid = ::fork();
    if (pid == 0) {
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
    const int a = connected_socket(in_port), b = connected_socket(out_port);
    std::mt19937 random(1);
    Distribution d;
    std::uint8_t buffer[64] = {};
    for (int i = 0; i < count; ++i) {
        const std::int64_t begun = clock_ns();
        (void)!::send(a, buffer, 17, MSG_NOSIGNAL);
        while (::recv(b, buffer, sizeof buffer, 0) <= 0) {
            if (clock_ns() - begun > 1'000'000'000) give_up("the relay does not answer");
        }
        d.us.push_back(static_cast<double>(clock_ns() - begun) * 1e-3);
        const std::int64_t next = begun + 500'000 + static_cast<std::int64_t>(random() % 2'000'000);
        while (clock_ns() < next) {
        }
    }
    ::close(a);
    ::close(b);
    ::close(in);
    ::close(out);
    int status = 0;
    ::kill(pid, SIGTERM);
    ::waitpid(pid, &status, 0);
    return d;
}

int run(const std::string& program_path, int count) {
    cpu_set_t own;
    CPU_ZERO(&own);
    const long processors = ::sysconf(_SC_NPROCESSORS_ONLN);
    cpu_set_t all;
    ::sched_getaffinity(0, sizeof all, &all);

    char folder[] = "/tmp/axisgate-bench-XXXXXX";
    if (!::mkdtemp(folder)) give_up("no temporary folder");
    struct Remove {
        std::string path;
        ~Remove() { std::filesystem::remove_all(path); }
    } remove{folder};

    std::vector<std::string> faults;
    const Family* family = find_family("uim342");
    const auto catalogue = Catalogue::parse(asset("schema/families/uim342.json"), faults);
    if (!family || !catalogue) give_up("the family uim342 is not there");

    Drive drive({family, &*catalogue});
    cpu_set_t others = all;
    if (processors > 1) CPU_CLR(static_cast<unsigned>(processors - 1), &others);
    Program program(program_path, folder, drive.port(), others);
    // The measuring thread looks without sleeping, and keeps one processor for itself; the gateway has the others.
    if (processors > 1) {
        CPU_SET(static_cast<unsigned>(processors - 1), &own);
        (void)::sched_setaffinity(0, sizeof own, &own);
    }
    std::bitset<128> everything;
    everything.set();
    const auto until = [&](auto&& condition, double limit_s, const char* what) {
        const std::int64_t end = clock_ns() + static_cast<std::int64_t>(limit_s * 1e9);
        while (!condition()) {
            (void)drive.pump(everything);
            if (clock_ns() > end) give_up(std::string(what) + " takes too long");
        }
    };
    const auto rest = [&](double s) {
        const std::int64_t end = clock_ns() + static_cast<std::int64_t>(s * 1e9);
        while (clock_ns() < end)
            (void)drive.pump(everything);
    };
    std::uint16_t port = 0;
    until([&] { return (port = program.ready()) != 0; }, 10, "getting ready");
    rest(1.0);
    Client client(port);
    const auto write = [&](std::uint16_t address, std::initializer_list<std::uint16_t> values) {
        client.write(address, values);
        until([&] { return client.answered(); }, 5, "a Modbus write");
    };
    write(33, {3});  // profile velocity
    write(38, {0, 20000, 0, 20000});
    for (const int word : {0x06, 0x07, 0x0F})
        write(32, {static_cast<std::uint16_t>(word)});
    write(42, {0, 500});
    // What the gateway asks by itself: anything else is what a write has caused.
    drive.functions.reset();
    rest(1.0);
    const std::bitset<128> polls = drive.functions;
    std::mt19937 random(1);
    Distribution frame, answer;
    int missed = 0;
    for (int i = 0; i < count + 50; ++i) {
        const std::int64_t begun = clock_ns();
        client.write(42, {0, static_cast<std::uint16_t>(1000 + i % 1000)});
        std::int64_t seen = 0, done = 0;
        while (seen == 0 || done == 0) {
            if (const std::int64_t t = drive.pump(polls); t != 0 && seen == 0) seen = t;
            if (done == 0 && client.answered()) done = clock_ns();
            if (clock_ns() - begun > 1'000'000'000) {
                ++missed;
                break;
            }
        }
        if (i >= 50 && seen != 0 && done != 0) {
            frame.us.push_back(static_cast<double>(seen - begun) * 1e-3);
            answer.us.push_back(static_cast<double>(done - begun) * 1e-3);
        }
        const std::int64_t next = begun + 500'000 + static_cast<std::int64_t>(random() % 2'000'000);
        while (clock_ns() < next)
            (void)drive.pump(polls);
    }
    if (missed != 0 || frame.us.empty()) give_up(std::to_string(missed) + " writes caused no frame, or had no answer");
    Distribution bare = relay(count / 4, processors > 1 ? 0 : -1);
    (void)::sched_setaffinity(0, sizeof all, &all);

    std::printf("the real program: Modbus write (FC 16) to the frame on the drive's line (TCP), %zu writes\n", frame.us.size());
    const bool kept = say("99th percentile", frame.at(0.99) / 200.0, "<=", 1.0, "axisgate", frame.at(0.99), "limit", 200, "us");
    std::printf("    %-34s axisgate %.0f / %.0f / %.0f / %.0f us, bare relay %.0f / %.0f / %.0f / %.0f us\n", "median / 90 / 99 / 99.9 %",
                frame.at(0.5), frame.at(0.9), frame.at(0.99), frame.at(0.999), bare.at(0.5), bare.at(0.9), bare.at(0.99), bare.at(0.999));
    std::printf("    %-34s ratio %.2f at the median, %.2f at 99 %% (no limit)\n", "axisgate / bare relay", frame.at(0.5) / bare.at(0.5),
                frame.at(0.99) / bare.at(0.99));
    std::printf("    %-34s %.0f / %.0f us at the median / 99 %% (no limit)\n", "write to its Modbus answer", answer.at(0.5),
                answer.at(0.99));
    std::printf(kept ? "all limits kept\n" : "NOT all limits kept\n");
    return kept ? 0 : 1;
}
}  // namespace
}  // namespace axisgate::bench

int main(int argc, char** argv) {
    std::string program;
    int count = 4000;
    bool report_only = false;
    for (int i = 1; i < argc; ++i) {
        const std::string a = argv[i];
        if (a == "--writes" && i + 1 < argc) {
            count = std::clamp(std::atoi(argv[++i]), 100, 1'000'000);
        } else if (a == "--report-only") {
            report_only = true;
        } else if (program.empty() && !a.starts_with("--")) {
            program = a;
        } else {
            program.clear();
            break;
        }
    }
    if (program.empty()) {
        std::fputs("bench_write PROGRAM [--writes N] [--report-only]\n", stderr);
        return 2;
    }
    const int code = axisgate::bench::run(program, count);
    return report_only ? 0 : code;
}
