// A file is written beside its place, flushed to the disk, and moved over an existing one; "-" reads standard input. Faults are texts with
// the system's reason, and reads are limited.
#include "gateway/runtime/files.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace axisgate {

std::optional<std::string> read_file(const std::string& path, std::string& fault, std::size_t limit) {
    const bool standard = path == "-";
    const int fd = standard ? 0 : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        fault = fmt::format("cannot read {}: {}", path, std::strerror(errno));
        return std::nullopt;
    }
    std::string text;
    char buffer[65536];
    ssize_t n = 0;
    while ((n = ::read(fd, buffer, sizeof buffer)) > 0 || (n < 0 && errno == EINTR)) {
        if (n < 0) continue;
        text.append(buffer, static_cast<std::size_t>(n));
        if (text.size() > limit) {
            fault = fmt::format("{} is larger than {} bytes", path, limit);
            break;
        }
    }
    if (n < 0 && fault.empty()) fault = fmt::format("cannot read {}: {}", path, std::strerror(errno));
    if (!standard) ::close(fd);
    if (!fault.empty()) return std::nullopt;
    return text;
}

std::string write_file(const std::string& path, std::string_view text) {
    const std::string temporary = path + ".new";
    const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0640);
    if (fd < 0) return fmt::format("cannot write {}: {}", temporary, std::strerror(errno));
    bool good = true;
    for (std::size_t done = 0; good && done < text.size();) {
        const ssize_t n = ::write(fd, text.data() + done, text.size() - done);
        if (n < 0 && errno == EINTR) continue;
        good = n > 0;
        if (good) done += static_cast<std::size_t>(n);
    }
    good = good && ::fsync(fd) == 0;
    const int error = errno;
    ::close(fd);
    if (!good || ::rename(temporary.c_str(), path.c_str()) != 0) {
        const std::string why = std::strerror(good ? errno : error);
        ::unlink(temporary.c_str());
        return fmt::format("cannot write {}: {}", path, why);
    }
    return {};
}

std::string write_secret(const std::string& path, std::string_view text) {
    const std::string beside = path + ".new";
    (void)::unlink(beside.c_str());
    const int fd = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (fd < 0) return std::strerror(errno);
    int error = 0;
    while (!text.empty() && error == 0) {
        const auto n = ::write(fd, text.data(), text.size());
        if (n >= 0) {
            text.remove_prefix(static_cast<std::size_t>(n));
        } else if (errno != EINTR) {
            error = errno;
        }
    }
    if (error == 0 && ::fsync(fd) != 0) error = errno;
    (void)::close(fd);
    if (error == 0 && std::rename(beside.c_str(), path.c_str()) != 0) error = errno;
    if (error != 0) (void)::unlink(beside.c_str());
    return error == 0 ? std::string() : std::strerror(error);
}

}  // namespace axisgate
