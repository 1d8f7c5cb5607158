// Stream benchmark: a crowd of live-feed clients that watch what the page watches; what the program's processor time for them is.
// In: where the program listens, its process id. Out: the ratio to the limit, and whether every client was told all; exit 1 if a limit is
// not kept. Clients here only count: frames are taken apart, texts are not read.
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/http_load.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {
namespace {
constexpr double most_processor = 0.5;  // of one core
constexpr double least_told = 0.9;      // of the states that were due: an axis that moves is told once per period, if it was heard in it
constexpr double longest_gap_s = 1.0;   // of one client, between two reads
constexpr std::size_t most_frame = 1 << 20;

struct Client {
    int fd = -1;
    std::string in;
    std::size_t axes = 0, others = 0, bytes = 0;
    double heard_s = 0, gap_s = 0;
};

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// User and system time of a process, s.
double used_s(int pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
    std::string all((std::istreambuf_iterator<char>(file)), {});
    const auto end = all.rfind(')');
    if (end == std::string::npos) return -1;
    unsigned long user = 0, system = 0;
    if (std::sscanf(all.c_str() + end + 1, " %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &user, &system) != 2) return -1;
    return static_cast<double>(user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

bool send_all(int fd, std::string_view bytes) {
    return ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

/// A client's frame; its mask is zero, which masks nothing.
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
bool open_client(Client& c, Address address, int period_ms) {
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
    return send_all(c.fd, client_frame(1, R"({"subscribe":["site","events","alarms"],"period_ms":1000})")) &&
           send_all(c.fd, client_frame(1, R"({"subscribe":["axes/*"],"period_ms":)" + std::to_string(period_ms) + "}")) &&
           send_all(c.fd, client_frame(1, R"({"subscribe":["drives/*","lines/*"],"period_ms":500})"));
}

/// Takes the whole frames out of what has come. False: closed, or not what a server sends.
bool take(Client& c) {
    static std::array<char, 256 * 1024> part;
    const auto n = ::recv(c.fd, part.data(), part.size(), MSG_DONTWAIT);
    if (n < 0 && errno == EAGAIN) return true;
    if (n <= 0) return false;
    const double now = now_s();
    c.gap_s = std::max(c.gap_s, now - c.heard_s);
    c.heard_s = now;
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
            return false;  // masked, or larger than anything that is told here
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

class Crowd {
public:
    Crowd(Address address, std::size_t count, int period_ms) : poller_(::epoll_create1(0)), clients_(count) {
        for (std::size_t i = 0; i < count && good_; ++i) {
            good_ = open_client(clients_[i], address, period_ms);
            epoll_event e{};
            e.events = EPOLLIN;
            e.data.u64 = i;
            ::epoll_ctl(poller_, EPOLL_CTL_ADD, clients_[i].fd, &e);
            run(0.002);
        }
    }
    ~Crowd() {
        for (const auto& c : clients_)
            ::close(c.fd);
        ::close(poller_);
    }
    Crowd(const Crowd&) = delete;
    Crowd& operator=(const Crowd&) = delete;
    /// Reads what comes for that long.
    void run(double seconds) {
        const double end = now_s() + seconds;
        epoll_event events[128];
        while (good_ && now_s() < end) {
            const int n = ::epoll_wait(poller_, events, 128, 10);
            for (int i = 0; i < n && good_; ++i)
                good_ = take(clients_[events[i].data.u64]);
        }
    }
    void forget() {
        for (auto& c : clients_) {
            c.axes = c.others = c.bytes = 0;
            c.gap_s = 0;
            c.heard_s = now_s();
        }
    }
    [[nodiscard]] bool good() const { return good_; }
    [[nodiscard]] const std::vector<Client>& clients() const { return clients_; }

private:
    int poller_;
    std::vector<Client> clients_;
    bool good_ = true;
};

int run(Address program, int pid, int clients, int axes, int period_ms, double seconds) {
    auto here = std::make_unique<Crowd>(program, static_cast<std::size_t>(clients), period_ms);
    Crowd& crowd = *here;
    crowd.run(1.0);  // the first states of all
    crowd.forget();
    const double before = used_s(pid), begun = now_s();
    crowd.run(seconds);
    const double took = now_s() - begun, used = (used_s(pid) - before) / took;
    if (!crowd.good() || before < 0) {
        std::printf("    a client was refused or closed  NOT KEPT\n");
        return 1;
    }
    const double due = took * 1000 / period_ms * axes;
    double least = 1e300, gap = 0, bytes = 0, messages = 0;
    for (const auto& c : crowd.clients()) {
        least = std::min(least, static_cast<double>(c.axes) / due);
        gap = std::max(gap, c.gap_s);
        bytes += static_cast<double>(c.bytes);
        messages += static_cast<double>(c.axes + c.others);
    }
    here.reset();
    ::usleep(500'000);
    const double left = used_s(pid), left_at = now_s();
    ::usleep(3'000'000);
    const double alone = (used_s(pid) - left) / (now_s() - left_at);
    bool kept = say("processor time", used / most_processor, "<=", 1, "axisgate", used, "limit", most_processor, "of one core");
    std::printf("    %-34s %.3f of one core when the clients have left; %.0f messages/s, %.1f MB/s, %.2f us per message\n", "", alone,
                messages / took, bytes / took * 1e-6, (used - alone) * took / messages * 1e6);
    kept &= say("states told, of those due (least)", least, ">=", least_told, "told", least * due / took, "due", due / took, "/s");
    kept &= say("longest silence of a client", gap / longest_gap_s, "<=", 1, "axisgate", gap, "limit", longest_gap_s, "s");
    std::printf(kept ? "all limits kept\n" : "NOT all limits kept\n");
    return kept ? 0 : 1;
}
}  // namespace
}  // namespace axisgate::bench

int main(int argc, char** argv) {
    using namespace axisgate::bench;
    Address program;
    if (argc < 7 || !parse_address(argv[1], program)) {
        std::fputs(
            "bench_stream HOST:PORT PID CLIENTS AXES PERIOD_MS SECONDS: watches the program that listens there; its axes must move\n",
            stderr);
        return 2;
    }
    pin(1);
    return run(program, std::atoi(argv[2]), std::clamp(std::atoi(argv[3]), 1, 1000), std::atoi(argv[4]), std::max(10, std::atoi(argv[5])),
               std::atof(argv[6]));
}
