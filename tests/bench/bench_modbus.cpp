// The Modbus benchmark measures the door against a plain epoll server that answers the same bytes. For each point it prints the ratio, its
// limit and both figures; exit 1 if a limit is exceeded. The servers run one at a time on one core, the load generator on the other. They
// take turns in short slices, so that disturbances of the machine affect both; the figure is the median of the slices' ratios.
#include <fcntl.h>
#include <sched.h>
#include <sys/epoll.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/modbus_load.hpp"
#include "tests/bench/modbus_servers.hpp"

namespace axisgate::bench {
namespace {

struct Options {
    double seconds = 2.0;  // per server and point
    int slices = 5;
    int server_cpu = 0;
    int load_cpu = 1;
    int spin_us = 0;
    std::string connect;               // empty: the door in this process
    std::string point;                 // empty: all
    std::optional<double> least_rate;  // instead of the limit of the point
    bool busy_load = false;
    bool report_only = false;
};

constexpr const char* usage =
    "bench_modbus [--seconds S] [--slices N] [--server-cpu N] [--load-cpu N] [--spin-us US] [--connect HOST:PORT]\n"
    "             [--point NAME] [--least-rate R] [--busy-load] [--report-only]\n"
    "  --seconds S          measuring time per server and point (default 2)\n"
    "  --slices N           into how many slices it is cut; the servers take turns (default 5)\n"
    "  --spin-us US         the door's loop polls so long before it sleeps (default 0; only without --connect)\n"
    "  --connect HOST:PORT  measure the program that listens there; axes 1 and 2 must be configured\n"
    "  --point NAME         only this one: REGISTERSxCONNECTIONSxIN_FLIGHT, for example 10x64x1, or idle\n"
    "  --least-rate R       limit for the rate, in plain servers (default: the point's own)\n"
    "  --busy-load          the load generator never sleeps, so that only the server's wake-ups are measured\n"
    "  --report-only        exit 0 even if a limit is not kept\n";

std::optional<Options> parse(int argc, char** argv) {
    Options o;
    for (int i = 1; i < argc; ++i) {
        const std::string_view a = argv[i];
        if (a == "--report-only") {
            o.report_only = true;
            continue;
        }
        if (a == "--busy-load") {
            o.busy_load = true;
            continue;
        }
        if (i + 1 >= argc) return std::nullopt;
        const char* value = argv[++i];
        if (a == "--seconds") {
            o.seconds = std::clamp(std::atof(value), 0.1, 60.0);
        } else if (a == "--slices") {
            o.slices = std::clamp(std::atoi(value), 1, 101);
        } else if (a == "--server-cpu") {
            o.server_cpu = std::atoi(value);
        } else if (a == "--load-cpu") {
            o.load_cpu = std::atoi(value);
        } else if (a == "--spin-us") {
            o.spin_us = std::max(0, std::atoi(value));
        } else if (a == "--connect") {
            o.connect = value;
        } else if (a == "--point") {
            o.point = value;
        } else if (a == "--least-rate") {
            o.least_rate = std::atof(value);
        } else {
            return std::nullopt;
        }
    }
    return o;
}

double median(std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
}

struct Point {
    std::uint16_t registers;
    int connections;
    int in_flight;
    double least_rate;               // of the plain server's
    std::optional<double> most_p99;  // of the plain server's; with pipelining, latency is queueing and has no limit of its own
};
constexpr Point points[] = {{10, 1, 1, 0.85, 1.3},   {10, 8, 1, 0.85, 1.3},         {10, 64, 1, 0.85, 1.3},
                            {10, 512, 1, 0.92, 1.3}, {10, 8, 8, 0.5, std::nullopt}, {125, 1, 1, 0.85, 1.3},
                            {125, 8, 1, 0.85, 1.3},  {125, 64, 1, 0.85, 1.3},       {125, 8, 8, 0.5, std::nullopt}};

bool say(const char* what, double ratio, const char* relation, double limit, bool kept, double ours, const char* versus, double theirs,
         const char* unit) {
    std::printf("    %-12s ratio %5.3f  limit %s %.2f  %-8s  axisgate %.*f %s, %s %.*f %s\n", what, ratio, relation, limit,
                kept ? "kept" : "NOT KEPT", ours < 1000 ? 1 : 0, ours, unit, versus, theirs < 1000 ? 1 : 0, theirs, unit);
    std::fflush(stdout);
    return kept;
}

/// Slices of `a` and `b` in turn.
struct Comparison {
    std::vector<double> rate_a, rate_b, p99_a, p99_b, rate_ratio, p99_ratio;
    double answers_a = 0, answers_b = 0;
    bool good = true;
};
Comparison compare(Load& a, Load& b, const Options& o) {
    Comparison c;
    const double slice = o.seconds / o.slices;
    (void)a.run(slice / 5);  // warm-up
    (void)b.run(slice / 5);
    for (int i = 0; i < o.slices; ++i) {
        const bool first = i % 2 == 0;
        const LoadResult x = (first ? a : b).run(slice);
        const LoadResult y = (first ? b : a).run(slice);
        const LoadResult& ra = first ? x : y;
        const LoadResult& rb = first ? y : x;
        c.good = c.good && ra.good && rb.good;
        c.answers_a += static_cast<double>(ra.answers);
        c.answers_b += static_cast<double>(rb.answers);
        c.rate_a.push_back(ra.per_second);
        c.rate_b.push_back(rb.per_second);
        c.p99_a.push_back(ra.p99_us);
        c.p99_b.push_back(rb.p99_us);
        c.rate_ratio.push_back(ra.per_second / rb.per_second);
        c.p99_ratio.push_back(ra.p99_us / rb.p99_us);
    }
    return c;
}

/// The same eight clients with and without 512 idle ones.
bool run_idle(const Options& o, Address ours) {
    bool kept = true;
    std::printf("FC 3, 10 registers, 8 connections, 1 in flight each, beside 512 open idle connections\n");
    Load load(ours, 8, 1, 10);
    std::vector<double> rates, latencies, rate_without, rate_with, p99_without, p99_with;
    const double slice = o.seconds / o.slices;
    for (int i = 0; i < o.slices; ++i) {
        LoadResult without, with;
        const auto measure_with = [&] {
            IdleConnections idle(ours, 512);
            with = load.run(slice);
            if (!idle.good()) std::printf("    not all of the 512 idle connections stayed open\n");
            kept &= idle.good();
        };
        if (i % 2 == 0) without = load.run(slice);
        measure_with();
        if (i % 2 != 0) without = load.run(slice);
        if (!without.good || !with.good) {
            std::printf("    a connection was lost: %s\n", load.fault().c_str());
            return false;
        }
        rate_without.push_back(without.per_second);
        rate_with.push_back(with.per_second);
        p99_without.push_back(without.p99_us);
        p99_with.push_back(with.p99_us);
        rates.push_back(with.per_second / without.per_second);
        latencies.push_back(with.p99_us / without.p99_us);
    }
    kept &=
        say("requests/s", median(rates), ">=", 0.95, median(rates) >= 0.95, median(rate_with), "without them", median(rate_without), "/s");
    kept &= say("p99", median(latencies), "<=", 1.3, median(latencies) <= 1.3, median(p99_with), "without them", median(p99_without), "us");
    return kept;
}

int run(const Options& o) {
    rlimit files{};
    ::getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = std::min<rlim_t>(files.rlim_max, 4096);
    ::setrlimit(RLIMIT_NOFILE, &files);

    std::optional<DoorServer> door;
    Address ours;
    if (o.connect.empty()) {
        door.emplace(o.server_cpu, o.spin_us);
        ours = door->address();
    } else if (!parse_address(o.connect, ours)) {
        std::fprintf(stderr, "--connect %s: write an IPv4 address and a port, for example 127.0.0.1:1502\n", o.connect.c_str());
        return 2;
    }
    PlainServer plain(o.server_cpu);
    pin(o.load_cpu);

    bool kept = true;
    for (const Point& p : points) {
        const std::string name = std::to_string(p.registers) + "x" + std::to_string(p.connections) + "x" + std::to_string(p.in_flight);
        if (!o.point.empty() && o.point != name) continue;
        std::printf("FC 3, %u registers, %d connection%s, %d in flight each\n", unsigned{p.registers}, p.connections,
                    p.connections == 1 ? "" : "s", p.in_flight);
        plain.answer_with(p.registers);
        Load a(ours, p.connections, p.in_flight, p.registers);
        Load b(plain.address(), p.connections, p.in_flight, p.registers);
        if (o.busy_load) {
            a.never_sleep();
            b.never_sleep();
        }
        const double used_a = door ? door->used_seconds() : 0;
        const double used_b = plain.used_seconds();
        const Comparison c = compare(a, b, o);
        if (!c.good) {
            std::printf("    a connection was lost or an answer was wrong: %s%s\n", a.fault().c_str(), b.fault().c_str());
            return 1;
        }
        const double rate = median(c.rate_ratio);
        const double least = o.least_rate.value_or(p.least_rate);
        kept &= say("requests/s", rate, ">=", least, rate >= least, median(c.rate_a), "plain epoll", median(c.rate_b), "/s");
        const double p99 = median(c.p99_ratio);
        if (p.most_p99) {
            kept &= say("p99", p99, "<=", *p.most_p99, p99 <= *p.most_p99, median(c.p99_a), "plain epoll", median(c.p99_b), "us");
        } else {
            std::printf("    %-12s ratio %5.3f  (no limit)  axisgate %.1f us, plain epoll %.1f us\n", "p99", p99, median(c.p99_a),
                        median(c.p99_b));
        }
        if (door) {
            const double own = (door->used_seconds() - used_a) / c.answers_a * 1e6;
            const double other = (plain.used_seconds() - used_b) / c.answers_b * 1e6;
            std::printf("    %-12s ratio %5.3f  (no limit)  axisgate %.2f us, plain epoll %.2f us per answer\n", "processor", own / other,
                        own, other);
        }
    }

    if (o.point.empty() || o.point == "idle") kept &= run_idle(o, ours);
    std::printf(kept ? "all limits kept\n" : "NOT all limits kept\n");
    return kept || o.report_only ? 0 : 1;
}

}  // namespace
}  // namespace axisgate::bench

int main(int argc, char** argv) {
    const auto options = axisgate::bench::parse(argc, argv);
    if (!options) {
        std::fputs(axisgate::bench::usage, stderr);
        return 2;
    }
    return axisgate::bench::run(*options);
}
