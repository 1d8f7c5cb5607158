// Tries operations whose success permissions do not show (a full or read-only disk, /proc). A log file or folder that does not exist is
// made and removed again.
#include "gateway/runtime/config_host.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "gateway/runtime/doors.hpp"

namespace axisgate {
namespace {
namespace fs = std::filesystem;

/// The reason why a file cannot be opened for writing; empty: it can. The log makes missing folders itself, so the existing one above them
/// must be writable.
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
    for (const DoorDescriptor* door : all_doors()) {
        if (door->warn) door->warn(c, out);
    }
    return out;
}

std::vector<ConfigFault> check_door_files(const Config& c, std::int64_t now_unix_s) {
    std::vector<ConfigFault> out;
    for (const DoorDescriptor* door : all_doors()) {
        if (!door->check_files) continue;
        for (auto& fault : door->check_files(c, now_unix_s))
            out.push_back(std::move(fault));
    }
    return out;
}

}  // namespace axisgate
