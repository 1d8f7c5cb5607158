// Configuration against this host: tries what rights alone do not tell (a full or read-only disk, /proc).
// In: a Config. Out: faults. A log file or folder that is not there yet is made and taken away again. Never leaves a file behind.
#include "gateway/runtime/config_host.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "gateway/doors/http/hosts.hpp"

namespace axisgate {
namespace {
namespace fs = std::filesystem;

/// Why a file cannot be opened for writing; empty: it can. Folders that are missing are made by the log itself: then the one above must
/// take them.
std::string why_not_writable(const fs::path& file) {
    std::error_code ec;
    if (fs::is_directory(file, ec)) return "it is a folder";
    fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (!fs::exists(folder, ec)) {
        fs::path missing = folder;
        while (missing.has_parent_path() && missing != missing.parent_path() && !fs::exists(missing.parent_path(), ec))
            missing = missing.parent_path();
        ec.clear();
        if (!fs::create_directory(missing, ec))
            return fmt::format("the folder {} cannot be made{}", missing.string(), ec ? ": " + ec.message() : "");
        fs::remove(missing, ec);
        return {};
    }
    const bool there = fs::exists(file, ec);
    const int fd = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NONBLOCK | (there ? 0 : O_CREAT | O_EXCL), 0600);
    if (fd < 0) return std::error_code(errno, std::generic_category()).message();
    (void)::close(fd);
    if (!there) (void)::unlink(file.c_str());
    return {};
}

std::string processors(const cpu_set_t& set) {
    std::string s;
    for (int i = 0; i < CPU_SETSIZE; ++i) {
        if (CPU_ISSET(i, &set)) s += fmt::format("{}{}", s.empty() ? "" : ", ", i);
    }
    return s;
}
}  // namespace

std::vector<ConfigFault> check_host(const Config& c) {
    std::vector<ConfigFault> out;
    if (!c.log_file.empty()) {
        if (const auto why = why_not_writable(c.log_file); !why.empty())
            out.push_back({"log.file", fmt::format("cannot open the log file {}: {}", c.log_file, why),
                           "check the folder and its rights, or leave log.file empty"});
    }
    cpu_set_t set;
    CPU_ZERO(&set);
    if (c.hot_cpu >= 0 && sched_getaffinity(0, sizeof set, &set) == 0 &&
        (c.hot_cpu >= CPU_SETSIZE || !CPU_ISSET(static_cast<int>(c.hot_cpu), &set))) {
        ConfigFault f{"runtime.hot_cpu", fmt::format("this process cannot run on processor {}: the hot loop will run on any", c.hot_cpu),
                      fmt::format("choose one of {}, or -1", processors(set))};
        f.warning = true;
        out.push_back(std::move(f));
    }
    if (!c.http_bind.empty() && c.http_allowed_hosts.empty() && !http::host_is_loopback(c.http_bind)) {
        ConfigFault f{
            "http.allowed_hosts",
            fmt::format("the HTTP door listens beyond this machine ({}) and no name is allowed: clients reach it by its IP addresses "
                        "alone, names get 421",
                        c.http_bind),
            "write the names that clients use, such as allowed_hosts = [\"axisgate.example\"]; nothing to do if they use addresses"};
        f.warning = true;
        out.push_back(std::move(f));
    }
    return out;
}

}  // namespace axisgate
