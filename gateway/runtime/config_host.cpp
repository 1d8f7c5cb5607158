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

#include "gateway/doors/http/hosts.hpp"

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

/// Warns of a door that other machines can reach and that requires no sign-in.
void warn_of_open_doors(const Config& c, std::vector<ConfigFault>& out) {
    const auto warn = [&out](std::string place, std::string text, std::string remedy) {
        ConfigFault f{std::move(place), std::move(text), std::move(remedy)};
        f.warning = true;
        out.push_back(std::move(f));
    };
    const auto beyond = [](const std::string& bind) { return !bind.empty() && !http::host_is_loopback(bind); };
    if (beyond(c.http_bind) && c.http_tls_cert.empty() && !c.http_tls_self_signed) {
        warn("http.tls_cert",
             fmt::format("the HTTP door listens beyond this machine ({}) without TLS: passwords and tokens cross the network in plain text",
                         c.http_bind),
             "name a certificate with [http] tls_cert and tls_key, or set tls = \"self_signed\", or listen on 127.0.0.1 behind a proxy "
             "that "
             "speaks TLS");
        if (c.users_local_role != "none")
            warn("users.local_role",
                 fmt::format("who reaches HTTP by this machine, as through a proxy or a forwarded port, is {} without a sign-in",
                             c.users_local_role),
                 "set [users] local_role = \"none\"");
    }
    if (beyond(c.modbus_bind) && c.modbus_allow.empty())
        warn("modbus.allow",
             fmt::format("Modbus/TCP listens beyond this machine ({}) and takes commands of every host that reaches it", c.modbus_bind),
             "write the addresses or networks of the controllers, such as allow = [\"192.168.1.20\"]");
    if (beyond(c.enip_bind))
        warn(
            "enip.bind",
            fmt::format("EtherNet/IP listens beyond this machine ({}) and takes commands of every host that reaches it; the protocol knows "
                        "no users",
                        c.enip_bind),
            "listen on the address of the machine network alone and keep others out of it by a firewall, or set [enip] bind = \"off\"");
    if (c.dds_enabled && c.dds_interface != "lo" && c.dds_security.empty())
        warn("dds.security",
             fmt::format(
                 "DDS runs on the interface {} without certificates: every program that reaches the domain commands axes, by any name",
                 c.dds_interface),
             "make certificates with `axisgate pki` and name their folder with [dds] security");
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
    warn_of_open_doors(c, out);
    return out;
}

}  // namespace axisgate
