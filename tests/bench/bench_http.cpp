// The HTTP benchmark requests one axis over REST from the program and from a bare Beast server that answers the same bytes. For each number
// of connections it prints the ratio, the limit and both figures; exit 1 if one is exceeded. Each server has one thread on one core; they
// take turns in short slices, and the load generator has the other core. The figure is the median of the slices' ratios, so that
// disturbances of the machine affect both.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/http_load.hpp"
#include "tests/bench/http_plain.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {
namespace {
constexpr double least_rate = 0.8;  // of the bare server's rate
constexpr int slices = 7;
constexpr int server_cpu = 0, load_cpu = 1;

double median(std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
}

/// The id of the program's thread for HTTP; 0 if there is none.
int door_thread(const std::string& pid) {
    std::error_code ec;
    for (const auto& task : std::filesystem::directory_iterator("/proc/" + pid + "/task", ec)) {
        std::string name;
        std::ifstream(task.path() / "comm") >> name;
        if (name == "axisgate-warm") return std::atoi(task.path().filename().c_str());
    }
    return 0;
}

/// Processor time of it so far, s.
double door_seconds(const std::string& pid, int thread) {
    double ns = 0;
    std::ifstream("/proc/" + pid + "/task/" + std::to_string(thread) + "/schedstat") >> ns;
    return ns * 1e-9;
}

/// Measures one number of connections; returns whether the limit is kept.
bool compare(Address program, const std::string& pid, int thread, PlainHttpServer& plain, const std::string& path, int connections,
             double seconds) {
    std::printf("GET %s, %d connections kept open, one request in flight each\n", path.c_str(), connections);
    HttpLoad a(program, path, connections), b(plain.address(), path, connections);
    std::vector<double> rate_a, rate_b, p99_a, p99_b, rates, p99s;
    const double slice = seconds / slices;
    (void)a.run(slice / 2);  // warm-up
    (void)b.run(slice / 2);
    const double used_a = door_seconds(pid, thread), used_b = plain.used_seconds();
    double answers_a = 0, answers_b = 0;
    for (int i = 0; i < slices; ++i) {
        const bool first = i % 2 == 0;
        const LoadResult x = (first ? a : b).run(slice), y = (first ? b : a).run(slice);
        if (!x.good || !y.good) {
            std::printf("    a connection was lost or an answer was wrong: %s%s  NOT KEPT\n", a.fault().c_str(), b.fault().c_str());
            return false;
        }
        const LoadResult &ours = first ? x : y, &theirs = first ? y : x;
        answers_a += static_cast<double>(ours.answers);
        answers_b += static_cast<double>(theirs.answers);
        rate_a.push_back(ours.per_second);
        rate_b.push_back(theirs.per_second);
        p99_a.push_back(ours.p99_us);
        p99_b.push_back(theirs.p99_us);
        rates.push_back(ours.per_second / theirs.per_second);
        p99s.push_back(ours.p99_us / theirs.p99_us);
    }
    const bool kept = say("requests/s", median(rates), ">=", least_rate, "axisgate", median(rate_a), "bare Beast", median(rate_b), "/s");
    std::printf("    %-34s ratio %10.3f  (no limit)  axisgate %.1f us, bare Beast %.1f us\n", "p99", median(p99s), median(p99_a),
                median(p99_b));
    const double each_a = (door_seconds(pid, thread) - used_a) / answers_a * 1e6,
                 each_b = (plain.used_seconds() - used_b) / answers_b * 1e6;
    std::printf("    %-34s ratio %10.3f  (no limit)  axisgate %.2f us, bare Beast %.2f us per answer\n", "processor", each_a / each_b,
                each_a, each_b);
    return kept;
}
}  // namespace
}  // namespace axisgate::bench

int main(int argc, char** argv) {
    using namespace axisgate::bench;
    Address program;
    if (argc < 4 || !parse_address(argv[1], program)) {
        std::fputs("bench_http HOST:PORT PID AXIS [SECONDS]: measures the program that listens there\n", stderr);
        return 2;
    }
    const std::string path = "/api/v1/axes/" + std::string(argv[3]);
    const double seconds = argc > 4 ? std::clamp(std::atof(argv[4]), 0.5, 60.0) : 2.0;
    pin(load_cpu);
    const HttpAnswer answer = ask_once(program, path);
    if (answer.head.empty()) {
        std::fprintf(stderr, "bench_http: %s does not answer with 200 at %s\n", path.c_str(), argv[1]);
        return 2;
    }
    std::printf("an answer of %zu bytes, %zu of them body\n", answer.head.size() + 4 + answer.body.size(), answer.body.size());
    const int thread = door_thread(argv[2]);
    if (thread == 0) {
        std::fprintf(stderr, "bench_http: process %s has no thread for HTTP\n", argv[2]);
        return 2;
    }
    // With the nice value of the program's thread, so that a busy machine disturbs both alike.
    PlainHttpServer plain(server_cpu, ::getpriority(PRIO_PROCESS, static_cast<id_t>(thread)), answer.head, answer.body);
    bool kept = true;
    for (const int connections : {1, 8, 32})
        kept &= compare(program, argv[2], thread, plain, path, connections, seconds);
    std::printf(kept ? "all limits kept\n" : "NOT all limits kept\n");
    return kept ? 0 : 1;
}
