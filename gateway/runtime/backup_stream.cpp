// The system's calls, repeated when a signal interrupts them. Links are not followed where a file is made.
#include "gateway/runtime/backup_stream.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace axisgate {
namespace {
using Kind = BackupFault::Kind;

tl::unexpected<BackupFault> system_fault(Kind kind, std::string_view doing, const std::string& path) {
    const int error = errno;
    return backup_fault(kind, fmt::format("cannot {} {}: {}", doing, path, std::strerror(error)));
}
}  // namespace

BackupResult<std::size_t> TextSource::read(std::span<char> into) {
    const std::size_t n = std::min(into.size(), text_.size());
    std::copy_n(text_.begin(), n, into.begin());
    text_.remove_prefix(n);
    return n;
}

BackupResult<std::unique_ptr<FileSource>> FileSource::open(const std::string& path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return system_fault(Kind::cannot_read, "read", path);
    struct stat st {};
    if (::fstat(fd, &st) != 0 || !S_ISREG(st.st_mode)) {
        (void)::close(fd);
        return backup_fault(Kind::cannot_read, fmt::format("{} is not a file: name the file itself", path));
    }
    return std::unique_ptr<FileSource>(new FileSource(fd, path, static_cast<std::uint64_t>(st.st_size)));
}

FileSource::~FileSource() { (void)::close(fd_); }

BackupResult<std::size_t> FileSource::read(std::span<char> into) {
    std::size_t done = 0;
    while (done < into.size()) {
        const auto n = ::read(fd_, into.data() + done, into.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return system_fault(Kind::cannot_read, "read", path_);
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    return done;
}

BackupResult<std::unique_ptr<FileSink>> FileSink::create(const std::string& path) {
    (void)::unlink(path.c_str());
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (fd < 0) return system_fault(Kind::cannot_write, "write", path);
    const auto folder = std::filesystem::path(path).parent_path();
    struct stat st {};
    if (::geteuid() == 0 && ::stat(folder.empty() ? "." : folder.c_str(), &st) == 0) {
        [[maybe_unused]] const int r = ::fchown(fd, st.st_uid, st.st_gid);  // a file system without owners is no reason to fail
    }
    return std::unique_ptr<FileSink>(new FileSink(fd, path));
}

FileSink::~FileSink() { (void)::close(fd_); }

BackupResult<> FileSink::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const auto n = ::write(fd_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return system_fault(Kind::cannot_write, "write", path_);
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return {};
}

BackupResult<> FileSink::finish() {
    if (::fsync(fd_) != 0) return system_fault(Kind::cannot_write, "write", path_);
    return {};
}

}  // namespace axisgate
