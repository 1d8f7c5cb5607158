// The DDS benchmark measures the cost of 256 axes at 50 Hz for the gateway that publishes them and for one that reads them, and the time
// from a frame on a line of the real program to the sample at another gateway, beside a bare round trip of Cyclone DDS with the same types
// in the same run. It uses the loopback only; exit 1 if a limit is exceeded.
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/doors/dds/door.hpp"
#include "tests/bench/line_probe.hpp"
#include "tests/bench/report.hpp"
#include "tests/unit/http/fake_gateway.hpp"

namespace axisgate::bench {
namespace {
using http::test::FakeGateway;
constexpr int axes = 256, rate_hz = 50;
constexpr double cpu_limit_percent = 15, latency_limit_us = 2000, round_trips_most = 3;
constexpr std::uint32_t domain = 83;

double processor_s() {
    rusage u{};
    (void)::getrusage(RUSAGE_SELF, &u);
    const auto s = [](const timeval& t) { return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6; };
    return s(u.ru_utime) + s(u.ru_stime);
}

/// A process that ends with this one, and the text that it wrote to its pipe.
class Child {
public:
    explicit Child(const std::function<void(int)>& work) {
        int ends[2];
        if (::pipe(ends) != 0) give_up("no pipe");
        std::fflush(stdout);
        pid_ = ::fork();
        if (pid_ == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            ::close(ends[0]);
            work(ends[1]);
            ::_exit(0);
        }
        ::close(ends[1]);
        out_ = ends[0];
    }
    ~Child() {
        ::kill(pid_, SIGKILL);
        (void)::waitpid(pid_, nullptr, 0);
        ::close(out_);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    [[nodiscard]] double figure(int timeout_ms) const {
        double value = -1;
        pollfd p{out_, POLLIN, 0};
        if (::poll(&p, 1, timeout_ms) != 1 || ::read(out_, &value, sizeof value) != sizeof value) give_up("a process has no figure");
        return value;
    }

private:
    pid_t pid_ = -1;
    int out_ = -1;
};

std::string site_of(int count) {
    std::string lines, drives, all;
    for (int i = 0; i < count; ++i) {
        const std::string n = std::to_string(i + 1), line = "can" + std::to_string(i / 100), comma = i == 0 ? "" : ",";
        if (i % 100 == 0) lines += comma + R"({"name":")" + line + R"(","uri":"twin","family":"demo"})";
        drives += comma + R"({"name":"d)" + n + R"(","line":")" + line + R"(","address":)" + std::to_string(5 + i % 100) + "}";
        all += comma + R"({"name":"a)" + n + R"(","drive":"d)" + n + R"(","number":)" + n + "}";
    }
    return R"({"lines":[)" + lines + R"(],"drives":[)" + drives + R"(],"axes":[)" + all + "]}";
}

/// The share of a core, in percent, of a gateway with this number of axes, all of which change `rate_hz` times a second. Counting begins
/// when it knows `seen` axes of other gateways.
double share_of(const char* name, std::uint64_t instance, int count, bool moving, std::size_t seen, double seconds) {
    boost::asio::io_context context{1};
    FakeGateway gateway(site_of(count));
    for (int i = 0; i < count; ++i)
        gateway.set_picture("a" + std::to_string(i + 1), http::test::standing(i));
    dds::DoorSettings settings;
    settings.bus.domain = domain;
    settings.name = name;
    settings.version = "bench";
    settings.instance = instance;
    dds::DdsDoor door(
        context, gateway.ports(), [] { return at_ns(clock_ns()); }, std::move(settings));
    if (const auto fault = door.start(); !fault.empty()) give_up(fault);
    boost::asio::steady_timer timer(context);
    std::int64_t position = 0;
    std::function<void()> tick = [&] {
        timer.expires_after(std::chrono::milliseconds(1000 / rate_hz));
        timer.async_wait([&](const boost::system::error_code& ec) {
            if (ec) return;
            ++position;
            for (auto& [id, picture] : gateway.pictures) {
                picture.position = position;
                ++gateway.revisions[id];
            }
            tick();
        });
    };
    if (moving) tick();
    const auto others = [&door] {
        std::size_t n = 0;
        for (const auto& g : door.fleet())
            n += g.here ? 0 : g.axes.size();
        return n;
    };
    for (int i = 0; i < 200 && others() < seen; ++i) {
        (void)context.run_for(std::chrono::milliseconds(50));
        context.restart();
    }
    if (others() < seen) give_up("the gateways have not found each other");
    (void)context.run_for(std::chrono::seconds(1));
    context.restart();
    const std::int64_t begun = clock_ns();
    const double before = processor_s();
    (void)context.run_for(std::chrono::milliseconds(static_cast<int>(seconds * 1000)));
    return 100 * (processor_s() - before) / (static_cast<double>(clock_ns() - begun) * 1e-9);
}

/// A bus that wakes the thread that polls `fd`.
struct Listening {
    int fd = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    dds::Bus bus{[this] {
        const std::uint64_t one = 1;
        (void)!::write(fd, &one, sizeof one);
    }};
    void slept(int timeout_ms) {
        wait_for({fd}, timeout_ms);
        drain();
    }
    void drain() {
        std::uint64_t n = 0;
        (void)!::read(fd, &n, sizeof n);
    }
};

dds::BusSettings settings_of(const char* partition) {
    dds::BusSettings s;
    s.domain = domain;
    s.partition = partition;
    return s;
}

/// The other end of the bare round trip: it answers a state with a result.
void echo(int) {
    Listening here;
    if (const auto fault = here.bus.open(settings_of("bare"), {dds::Topic::command_result}, {dds::Topic::axis_state}); !fault.empty())
        give_up(fault);
    for (;;) {
        here.slept(1000);
        (void)here.bus.take<axisgate_AxisState>(64, [&here](const auto& s, const auto& seen) {
            if (!seen.valid) return;
            axisgate_CommandResult r{};
            dds::put_text(r.gateway, "bare");
            dds::put_text(r.axis, "bare");
            r.instance = s.instance;
            (void)here.bus.write(r);
        });
    }
}

Distribution round_trips(int count) {
    Distribution all;
    Listening here;
    if (const auto fault = here.bus.open(settings_of("bare"), {dds::Topic::axis_state}, {dds::Topic::command_result}); !fault.empty())
        give_up(fault);
    const std::int64_t limit = clock_ns() + 30'000'000'000;
    for (std::uint64_t n = 1; all.us.size() < static_cast<std::size_t>(count); ++n) {
        axisgate_AxisState s{};
        dds::put_text(s.gateway, "bare");
        dds::put_text(s.axis, "bare");
        s.instance = n;
        const std::int64_t begun = clock_ns();
        (void)here.bus.write(s);
        std::int64_t came = 0;
        while (came == 0 && clock_ns() - begun < 100'000'000) {
            here.slept(100);
            const std::int64_t now = clock_ns();
            (void)here.bus.take<axisgate_CommandResult>(64, [&](const auto& r, const auto&) { came = r.instance == n ? now : came; });
        }
        if (came != 0) all.us.push_back(static_cast<double>(came - begun) * 1e-3);
        if (clock_ns() > limit) give_up("the bare round trip takes too long");
        // The same distance as between the changes of an axis, because a process that is asked without a pause never sleeps.
        ::usleep(20'000);
    }
    return all;
}

/// The time from the frame with a new position to the sample with it.
Distribution frames_to_samples(const std::string& program_path, int count) {
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
    Program program(program_path, folder,
                    R"({"lines":[{"name":"l","uri":"tcp:127.0.0.1:)" + std::to_string(drive.port()) +
                        R"(","family":"uim342"}],"drives":[{"name":"d","line":"l","address":5,"presence":"device"}],)"
                        R"("axes":[{"name":"a","drive":"d","number":1}]})",
                    all,
                    {"http.bind=off", "modbus.bind=127.0.0.1:0", "enip.bind=off", "dds.enabled=true", "dds.name=probed",
                     "dds.domain=" + std::to_string(domain)});
    Listening here;
    if (const auto fault = here.bus.open(settings_of("plant"), {}, {dds::Topic::axis_state}); !fault.empty()) give_up(fault);
    std::bitset<128> everything;
    everything.set();
    Distribution d;
    std::int32_t position = 0x12340000;
    const std::int64_t limit = clock_ns() + 75'000'000'000;
    bool found = false;
    for (int n = 0; d.us.size() < static_cast<std::size_t>(count); ++n) {
        if (clock_ns() > limit) give_up("states do not come");
        if (!program.ready()) {
            ::usleep(10'000);
            (void)drive.pump(everything);
            continue;
        }
        drive.put(++position);
        std::int64_t came = 0;
        const std::int64_t begun = clock_ns();
        while (came == 0 && clock_ns() - begun < 1'000'000'000) {
            wait_for({drive.fd(), here.fd}, std::min(drive.timeout_ms(), 5));
            here.drain();
            const std::int64_t now = clock_ns();
            (void)here.bus.take<axisgate_AxisState>(64, [&](const auto& s, const auto&) { came = s.position == position ? now : came; });
            (void)drive.pump(everything);
        }
        if (came != 0 && drive.left_at() > 1 && found) d.us.push_back(static_cast<double>(came - drive.left_at()) * 1e-3);
        found = found || came != 0;
        // States of one axis are at least one turn apart, so that the waiting for a turn is not measured.
        const std::int64_t next = clock_ns() + 45'000'000;
        while (clock_ns() < next) {
            wait_for({drive.fd()}, std::min(drive.timeout_ms(), 5));
            (void)drive.pump(everything);
        }
    }
    return d;
}

/// The share of a core, in percent, of each of this number of gateways with 64 axes each, all at rest.
double share_of_member(int members) {
    constexpr int each = 64;
    std::vector<std::unique_ptr<Child>> fleet;
    for (int i = 0; i < members; ++i) {
        fleet.push_back(std::make_unique<Child>([i, members](int out) {
            const std::string name = "member-" + std::to_string(i);
            const double share =
                share_of(name.c_str(), 100 + static_cast<std::uint64_t>(i), each, false, static_cast<std::size_t>(each * (members - 1)), 6);
            (void)!::write(out, &share, sizeof share);
            ::pause();
        }));
    }
    double sum = 0;
    for (const auto& m : fleet)
        sum += m->figure(60'000);
    return sum / members;
}

int run(const std::string& program) {
    bool kept = true;
    // The children are forked first, because the library's threads do not survive a fork.
    {
        const Child other([](int out) {
            const double share = share_of("there", 2, axes, true, 0, 8);
            (void)!::write(out, &share, sizeof share);
            ::pause();
        });
        const Child listener([](int out) {
            const double share = share_of("here", 1, 1, false, axes, 4);
            (void)!::write(out, &share, sizeof share);
            ::pause();
        });
        const double published = other.figure(60'000), received = listener.figure(60'000);
        std::printf("256 axes of one gateway, all of which change 50 times a second; shares of one core\n");
        kept = say("to tell of them", published / cpu_limit_percent, "<=", 1.0, "axisgate", published, "limit", cpu_limit_percent, "%") &&
               kept;
        kept =
            say("to hear of them", received / cpu_limit_percent, "<=", 1.0, "axisgate", received, "limit", cpu_limit_percent, "%") && kept;
        std::printf("    %-34s %.2f us told, %.2f us heard (no limit)\n", "a sample", published * 1e4 / (axes * rate_hz),
                    received * 1e4 / (axes * rate_hz));
    }
    {
        constexpr int members = 12, plant = 50;
        const double alone = share_of_member(1), among = share_of_member(members);
        std::printf("    %-34s alone %.2f %%, among %d %.2f %%, so among %d %.2f %% (no limit)\n", "64 axes at rest", alone, members, among,
                    plant, alone + (among - alone) * (plant - 1) / (members - 1));
    }
    const Child echoing([](int out) { echo(out); });
    Distribution bare = round_trips(400);
    Distribution way = frames_to_samples(program, 200);
    std::printf("a frame on a line of the real program to the sample at another gateway, %zu of them; bare: round trip of Cyclone DDS\n",
                way.us.size());
    kept = say("99th percentile", way.at(0.99) / latency_limit_us, "<=", 1.0, "axisgate", way.at(0.99), "limit", latency_limit_us, "us") &&
           kept;
    kept = say("99th percentile to a round trip", way.at(0.99) / bare.at(0.99), "<=", round_trips_most, "axisgate", way.at(0.99), "bare",
               bare.at(0.99), "us") &&
           kept;
    std::printf("    %-34s axisgate %.0f / %.0f / %.0f us, bare %.0f / %.0f / %.0f us\n", "median / 99 % / longest", way.at(0.5),
                way.at(0.99), way.at(1), bare.at(0.5), bare.at(0.99), bare.at(1));
    std::printf(kept ? "all limits kept\n" : "NOT all limits kept\n");
    return kept ? 0 : 1;
}
}  // namespace
}  // namespace axisgate::bench

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("bench_dds PROGRAM\n", stderr);
        return 2;
    }
    return axisgate::bench::run(argv[1]);
}
