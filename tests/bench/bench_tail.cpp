// The tail benchmark measures the longest paths through the real program while all of it is busy, beside a bare relay under the same load.
// For each path it prints the median, 99, 99.9, 99.99 % and the maximum, the limits of two of them, and how many took longer than a
// millisecond, with those of the relay; exit 1 if a limit is exceeded. The load: 100 clients watch 33 axes at 20 Hz, 32 of which move; REST
// is used at half of its maximum rate; parameters are written and stored one after the other on four axes, each command is an event that is
// stored; a trace is downloaded every second. The prober sleeps like any client, and uses the kernel's time stamps of received data.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bitset>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/runtime/threads.hpp"
#include "tests/bench/http_load.hpp"
#include "tests/bench/line_probe.hpp"
#include "tests/bench/report.hpp"
#include "tests/bench/stream_crowd.hpp"

namespace axisgate::bench {
namespace {
constexpr int moving_axes = 32, streams = 100, stream_period_ms = 50, rest_connections = 8, parameter_axes = 4;
constexpr double p99_limit_us = 300, p9999_limit_us = 1000;
constexpr std::int64_t lost_ns = 5'000'000'000;

std::string site(std::uint16_t drive_port) {
    std::string lines = R"({"name":"l","uri":"tcp:127.0.0.1:)" + std::to_string(drive_port) + R"(","family":"uim342"})";
    std::string drives = R"({"name":"d","line":"l","address":5,"presence":"device"})";
    std::string axes = R"({"name":"a","drive":"d","number":1})";
    for (int i = 0; i < 2; ++i)
        lines += R"(,{"name":"can)" + std::to_string(i) + R"(","uri":"twin","family":"uim342","bitrate":1000000})";
    for (int i = 0; i < moving_axes; ++i) {
        const std::string name = "m" + std::to_string(i + 1);
        drives +=
            R"(,{"name":")" + name + R"(","line":"can)" + std::to_string(i % 2) + R"(","address":)" + std::to_string(11 + i / 2) + "}";
        axes += R"(,{"name":")" + name + R"(","drive":")" + name + R"(","number":)" + std::to_string(i + 2) + "}";
    }
    return R"({"lines":[)" + lines + R"(],"drives":[)" + drives + R"(],"axes":[)" + axes + "]}";
}

/// An HTTP client that never waits, with one request in progress.
class HttpClient {
public:
    explicit HttpClient(Address address) : address_(address), fd_(connected_socket(address.port)) {}
    ~HttpClient() { ::close(fd_); }
    HttpClient(const HttpClient&) = delete;
    HttpClient& operator=(const HttpClient&) = delete;
    void post(const std::string& path, const std::string& body) {
        const std::string r = http_request(address_, "POST", path, body);
        in_.clear();
        if (::write(fd_, r.data(), r.size()) != static_cast<ssize_t>(r.size())) give_up("a request could not be sent");
    }
    /// The time at which the answer was complete; 0: it is not. An answer other than success ends the benchmark.
    std::int64_t answered() {
        std::array<std::uint8_t, 4096> part;
        std::int64_t at = 0;
        const ssize_t n = receive(fd_, part, at);
        if (n == 0) give_up("the gateway closed the HTTP connection");
        if (n < 0) return 0;
        in_.append(part.begin(), part.begin() + n);
        const auto end = in_.find("\r\n\r\n"), field = in_.find("\r\nContent-Length: ");
        if (end == std::string::npos) return 0;
        if (!in_.starts_with("HTTP/1.1 2") || field > end) give_up("refused: " + in_);
        return in_.size() < end + 4 + static_cast<std::size_t>(std::atol(in_.c_str() + field + 18)) ? 0 : at;
    }
    [[nodiscard]] int fd() const noexcept { return fd_; }

private:
    Address address_;
    int fd_;
    std::string in_;
};

/// The rest of the program's load, from threads of lower priority. Ends with this object.
class Rush {
public:
    explicit Rush(Address http) : http_(http) {
        double most = 0;  // the rate of REST alone, at the beginning
        {
            HttpLoad alone(http, "/api/v1/axes/m1", rest_connections);
            most = alone.run(0.5).per_second;
        }
        std::printf("    %-34s %.0f requests/s alone\n", "REST", most);
        begin([this] {
            Crowd crowd(http_, streams, stream_period_ms, Crowd::Watches::axes);
            while (!stop_ && crowd.good())
                crowd.run(0.1);
            for (const auto& c : crowd.clients())
                published_ += c.axes + c.others;
            if (!crowd.good()) fault_ = "a stream was refused or closed";
        });
        begin([this] {
            // Half of the time at its full rate, in turns of 5 ms.
            HttpLoad load(http_, "/api/v1/axes/m1", rest_connections);
            while (!stop_) {
                const std::int64_t begun = clock_ns();
                count(load, 0.005, asked_);
                ::usleep(static_cast<useconds_t>((clock_ns() - begun) / 1000));
            }
        });
        begin([this] {
            while (!stop_) {
                HttpLoad load(http_, "/api/v1/lines/can0/trace?format=pcapng", 1);
                count(load, 0, traces_);
                for (int i = 0; i < 10 && !stop_; ++i)
                    ::usleep(100'000);
            }
        });
        for (int i = 0; i < parameter_axes; ++i) {
            begin([this, i] {
                HttpLoad load(http_, "/api/v1/axes/m" + std::to_string(i + 1) + "/parameters/AC", 1, "PUT", R"({"value":20000})");
                while (!stop_)
                    count(load, 0.1, written_);
            });
        }
        begun_s_ = now_s();
    }
    ~Rush() { end(); }
    Rush(const Rush&) = delete;
    Rush& operator=(const Rush&) = delete;
    /// Ends the load and prints its figures.
    void report() {
        const double took = now_s() - begun_s_;
        end();
        if (const char* f = fault_.load()) give_up(f);
        std::printf("    %-34s %.0f REST requests/s, %.0f parameters written/s, %.0f stream messages/s, %.1f traces/s\n", "meanwhile",
                    static_cast<double>(asked_) / took, static_cast<double>(written_) / took, static_cast<double>(published_) / took,
                    static_cast<double>(traces_) / took);
    }

private:
    template <class F>
    void begin(F work) {
        threads_.emplace_back([work] {
            enter_thread("bench-load", 10);
            work();
        });
    }
    void count(HttpLoad& load, double seconds, std::atomic<std::uint64_t>& into) {
        const LoadResult r = load.run(seconds);
        into += r.answers;
        if (!load.fault().empty()) {
            std::fprintf(stderr, "benchmark: %s\n", load.fault().c_str());
            fault_ = "the load was refused";
            stop_ = true;
        }
    }
    void end() {
        stop_ = true;
        for (auto& t : threads_)
            t.join();
        threads_.clear();
    }
    Address http_;
    double begun_s_ = 0;
    std::atomic<bool> stop_{false};
    std::atomic<const char*> fault_{nullptr};
    std::atomic<std::uint64_t> asked_{0}, written_{0}, published_{0}, traces_{0};
    std::vector<std::thread> threads_;
};

/// A path of the gateway and the bare relay at the same time: one message of the relay after each of the path's.
struct Way {
    Distribution gateway, relay;
};

bool say_tail(const char* name, Way& way) {
    Distribution &d = way.gateway, &bare = way.relay;
    std::printf("%s, %zu times\n", name, d.us.size());
    const double p99 = d.at(0.99), p9999 = d.at(0.9999);
    bool kept = say("99 %", p99 / p99_limit_us, "<=", 1, "axisgate", p99, "limit", p99_limit_us, "us");
    kept &= say("99.99 %", p9999 / p9999_limit_us, "<=", 1, "axisgate", p9999, "limit", p9999_limit_us, "us");
    std::printf("    %-34s axisgate %.0f / %.0f / %.0f / %.0f / %.0f us, bare relay %.0f / %.0f / %.0f / %.0f / %.0f us\n",
                "50 / 99 / 99.9 / 99.99 % / longest", d.at(0.5), p99, d.at(0.999), p9999, d.at(1), bare.at(0.5), bare.at(0.99),
                bare.at(0.999), bare.at(0.9999), bare.at(1));
    const auto beyond = [](const Distribution& of) { return std::ranges::count_if(of.us, [](double us) { return us > p9999_limit_us; }); };
    std::printf("    %-34s axisgate %td, bare relay %td\n", "beyond 1 ms", beyond(d), beyond(bare));
    std::fflush(stdout);
    return kept;
}

int run(const std::string& path, int count) {
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
    cpu_set_t all;
    ::sched_getaffinity(0, sizeof all, &all);
    Program program(path, folder, site(drive.port()), all, {"http.bind=127.0.0.1:0", "modbus.bind=127.0.0.1:0"});
    if (!go_first()) take_short_turns(hot_turn_ns);  // it represents a client and a drive that are separate machines
    std::bitset<128> polls;
    polls.set();
    std::int64_t frame_at = 0;
    // Until `done`, asleep in between; the first frame that is not a poll gets a time stamp.
    const auto until = [&](auto&& done, std::initializer_list<int> also, double limit_s, const char* what) {
        const std::int64_t end = clock_ns() + static_cast<std::int64_t>(limit_s * 1e9);
        while (!done()) {
            if (clock_ns() > end) give_up(std::string(what) + " takes too long");
            const int a = also.size() > 0 ? *also.begin() : -1;
            wait_for({drive.fd(), a}, drive.fd() < 0 ? 1 : std::min(drive.timeout_ms(), 10));
            if (const std::int64_t t = drive.pump(polls); t != 0 && frame_at == 0) frame_at = t;
        }
    };
    const auto rest = [&](double s) {
        const std::int64_t end = clock_ns() + static_cast<std::int64_t>(s * 1e9);
        until([&] { return clock_ns() >= end; }, {}, s + 10, "a pause");
    };
    until([&] { return program.ready(); }, {}, 10, "getting ready");
    rest(1.0);

    const Address address{0x7F000001, program.port("http")};
    {
        HttpClient http(address);
        const auto post = [&](const std::string& axis, const std::string& body) {
            http.post("/api/v1/axes/" + axis + "/commands?wait=5", body);
            until([&] { return http.answered() != 0; }, {http.fd()}, 10, "a command over HTTP");
        };
        for (int i = 0; i < moving_axes; ++i) {
            const std::string axis = "m" + std::to_string(i + 1);
            post(axis, R"({"command":"enable"})");
            post(axis, R"({"command":"move_velocity","velocity":)" + std::to_string(100 + i) + "}");
        }
    }
    ModbusClient modbus(program.port("modbus"));
    const auto write = [&](std::uint16_t at, std::initializer_list<std::uint16_t> values) {
        modbus.write(at, values);
        std::int64_t answered = 0;
        until([&] { return (answered = modbus.answered()) != 0; }, {modbus.fd()}, 10, "a Modbus write");
    };
    write(33, {3});  // profile velocity
    write(38, {0, 20000, 0, 20000});
    for (const int word : {0x06, 0x07, 0x0F})
        write(32, {static_cast<std::uint16_t>(word)});
    write(42, {0, 500});
    // The gateway's own questions: any other frame was caused by a command.
    drive.functions.reset();
    rest(1.0);
    polls = drive.functions;

    std::printf("the real program: %d axes move, %d streams, %ld processors\n", moving_axes, streams, ::sysconf(_SC_NPROCESSORS_ONLN));
    Rush rush(address);
    rest(1.0);
    const auto velocity = [](int i) { return 1000 + i % 1000; };
    const int warm_up = std::min(count / 10, 1000);
    Relay relay(-1, true);
    // From `begin` to the frame, or to the answer; the next one begins when both are over.
    const auto measure = [&](auto&& begin, auto&& answered, int fd, bool to_frame) {
        Way way;
        way.gateway.us.reserve(static_cast<std::size_t>(count));
        way.relay.us.reserve(static_cast<std::size_t>(count));
        for (int i = 0; i < count + warm_up; ++i) {
            frame_at = 0;
            const std::int64_t begun = clock_ns();
            begin(i);
            std::int64_t done = 0;
            while (done == 0 || (to_frame && frame_at == 0)) {
                wait_for({drive.fd(), fd}, std::min(drive.timeout_ms(), 10));
                if (const std::int64_t t = drive.pump(polls); t != 0 && frame_at == 0) frame_at = t;
                if (done == 0) done = answered();
                if (clock_ns() - begun > lost_ns) give_up("no answer, or no frame, for five seconds");
            }
            const double relayed_us = relay.once_us();
            if (i < warm_up) continue;
            way.gateway.us.push_back(static_cast<double>((to_frame ? frame_at : done) - begun) * 1e-3);
            way.relay.us.push_back(relayed_us);
        }
        return way;
    };
    Way writes = measure(
        [&](int i) {
            modbus.write(42, {0, static_cast<std::uint16_t>(velocity(i))});
        },
        [&] { return modbus.answered(); }, modbus.fd(), true);
    Way reads = measure([&](int) { modbus.read(0, 20); }, [&] { return modbus.answered(); }, modbus.fd(), false);
    HttpClient http(address);  // opened now, because the gateway closes a connection that is silent during the earlier measurements
    Way commands = measure(
        [&](int i) {
            http.post("/api/v1/axes/a/commands?wait=5", R"({"command":"move_velocity","velocity":)" + std::to_string(velocity(i)) + "}");
        },
        [&] { return http.answered(); }, http.fd(), true);
    rush.report();
    bool kept = say_tail("Modbus write (FC 16) to the frame on the drive's line (TCP)", writes);
    kept &= say_tail("Modbus read (FC 3, 20 registers) to its answer", reads);
    kept &= say_tail("command over HTTP to the frame on the drive's line (TCP)", commands);
    std::printf(kept ? "all limits kept\n" : "NOT all limits kept\n");
    return kept ? 0 : 1;
}
}  // namespace
}  // namespace axisgate::bench

int main(int argc, char** argv) {
    std::string program;
    int count = 200'000;
    for (int i = 1; i < argc; ++i) {
        const std::string a = argv[i];
        if (a == "--count" && i + 1 < argc) {
            count = std::clamp(std::atoi(argv[++i]), 1000, 10'000'000);
        } else if (program.empty() && !a.starts_with("--")) {
            program = a;
        } else {
            program.clear();
            break;
        }
    }
    if (program.empty()) {
        std::fputs("bench_tail PROGRAM [--count N]: N of each way, 200000 if not told\n", stderr);
        return 2;
    }
    return axisgate::bench::run(program, count);
}
