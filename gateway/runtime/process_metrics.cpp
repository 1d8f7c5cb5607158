// Reads memory, threads and descriptors from /proc/self at each call.
#include "gateway/runtime/process_metrics.hpp"

#include <dirent.h>
#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "gateway/core/histogram.hpp"
#include "gateway/runtime/clock.hpp"

namespace axisgate {
namespace {
double seconds_of(const timeval& t) { return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6; }

/// Entries of /proc/self/fd, without the one that counting needs; empty if it cannot be read.
std::uint64_t open_descriptors() {
    DIR* folder = ::opendir("/proc/self/fd");
    if (!folder) return 0;
    std::uint64_t n = 0;
    while (const dirent* entry = ::readdir(folder))
        n += entry->d_name[0] != '.' ? 1 : 0;
    ::closedir(folder);
    return n > 0 ? n - 1 : 0;
}
}  // namespace

std::string process_metrics() {
    std::string s;
    const auto put = [&s](std::string_view name, std::string_view type, std::string_view help, std::string_view value) {
        s += metric_head(name, type, help) + fmt::format("{} {}\n", name, value);
    };
    if (rusage u{}; ::getrusage(RUSAGE_SELF, &u) == 0) {
        put("process_cpu_seconds_total", "counter", "Processor time, user and system.",
            fmt::format("{:.6f}", seconds_of(u.ru_utime) + seconds_of(u.ru_stime)));
        put("process_major_page_faults_total", "counter", "Pages that had to be fetched from a disk.", fmt::format("{}", u.ru_majflt));
        put("process_involuntary_context_switches_total", "counter", "Times a thread lost its processor to somebody else.",
            fmt::format("{}", u.ru_nivcsw));
    }
    if (std::ifstream file("/proc/self/statm"); file) {
        std::uint64_t size = 0, resident = 0;
        const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
        if (file >> size >> resident) {
            put("process_virtual_memory_bytes", "gauge", "Virtual memory.", fmt::format("{}", size * page));
            put("process_resident_memory_bytes", "gauge", "Resident memory.", fmt::format("{}", resident * page));
            put("axisgate_resident_memory_bytes", "gauge", "Resident memory of the process.", fmt::format("{}", resident * page));
        }
    }
    if (const auto n = open_descriptors(); n > 0) put("process_open_fds", "gauge", "Open file descriptors.", fmt::format("{}", n));
    if (rlimit limit{}; ::getrlimit(RLIMIT_NOFILE, &limit) == 0)
        put("process_max_fds", "gauge", "File descriptors that the process may have.", fmt::format("{}", limit.rlim_cur));
    // Behind the command's closing bracket: state is field 3, threads 20, start time in ticks since the machine's start 22. (proc(5))
    if (std::ifstream file("/proc/self/stat"); file) {
        const std::string all{std::istreambuf_iterator<char>(file), {}};
        std::istringstream fields(all.substr(std::min(all.rfind(')') + 1, all.size())));
        std::string field;
        std::uint64_t threads = 0, ticks = 0;
        for (int i = 3; i <= 22 && fields >> field; ++i) {
            if (i == 20) threads = std::strtoull(field.c_str(), nullptr, 10);
            if (i == 22) ticks = std::strtoull(field.c_str(), nullptr, 10);
        }
        timespec up{};
        if (threads > 0) put("process_threads", "gauge", "Threads.", fmt::format("{}", threads));
        if (ticks > 0 && ::clock_gettime(CLOCK_BOOTTIME, &up) == 0) {
            const double since_boot = static_cast<double>(ticks) / static_cast<double>(::sysconf(_SC_CLK_TCK));
            const double boot = static_cast<double>(unix_now_ns()) * 1e-9 - static_cast<double>(up.tv_sec);
            put("process_start_time_seconds", "gauge", "When it was started, in seconds since 1970.",
                fmt::format("{:.0f}", boot + since_boot));
        }
    }
    return s;
}

}  // namespace axisgate
