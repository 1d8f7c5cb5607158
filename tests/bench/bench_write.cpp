// The write benchmark measures the time from a Modbus write to the real program to the frame that it causes on the drive's line. It prints
// the distribution, the limit for the 99th percentile, and the figures of a bare relay on this machine in the same run; exit 1 if the limit
// is exceeded. One thread is Modbus client and drive at once and notes both times.
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <bitset>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>

#include "gateway/core/assets.hpp"
#include "gateway/core/catalogue.hpp"
#include "tests/bench/line_probe.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {
namespace {

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
    Program program(program_path, folder,
                    R"({"lines":[{"name":"l","uri":"tcp:127.0.0.1:)" + std::to_string(drive.port()) +
                        R"(","family":"uim342"}],"drives":[{"name":"d","line":"l","address":5,"presence":"device"}],)"
                        R"("axes":[{"name":"a","drive":"d","number":1}]})",
                    others, {"http.bind=off", "modbus.bind=127.0.0.1:0"});
    // The measuring thread polls without sleeping on a processor of its own; the gateway has the others.
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
    until([&] { return program.ready(); }, 10, "getting ready");
    rest(1.0);
    ModbusClient client(program.port("modbus"));
    const auto write = [&](std::uint16_t address, std::initializer_list<std::uint16_t> values) {
        client.write(address, values);
        until([&] { return client.answered() != 0; }, 5, "a Modbus write");
    };
    write(33, {3});  // profile velocity
    write(38, {0, 20000, 0, 20000});
    for (const int word : {0x06, 0x07, 0x0F})
        write(32, {static_cast<std::uint16_t>(word)});
    write(42, {0, 500});
    // The gateway's own questions: any other frame was caused by a write.
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
            if (done == 0) done = client.answered();
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
    Distribution bare = relay(count / 4, processors > 1 ? 0 : -1, 500'000);
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
