// The stream benchmark measures the program's processor time for many live-feed clients that subscribe to the topics of the page. It prints
// the ratio to the limit, and whether every client received everything; exit 1 if a limit is exceeded. The clients only count frames and do
// not read their texts.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "tests/bench/modbus_load.hpp"
#include "tests/bench/report.hpp"
#include "tests/bench/stream_crowd.hpp"

namespace axisgate::bench {
namespace {
constexpr double most_processor = 0.15;  // of one core
constexpr double least_published = 0.9;  // of the states that were due: a moving axis is sent once per period, if it has reported in it
constexpr double longest_gap_s = 1.0;    // of one client, between two reads

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

int run(Address program, int pid, int clients, int axes, int period_ms, double seconds) {
    auto here = std::make_unique<Crowd>(program, static_cast<std::size_t>(clients), period_ms);
    Crowd& crowd = *here;
    crowd.run(1.0);  // the first states
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
    kept &= say("states told, of those due (least)", least, ">=", least_published, "told", least * due / took, "due", due / took, "/s");
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
