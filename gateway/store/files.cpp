// The files of the data directory, through the system's calls, because mode, owner, fsync and flock have no portable form. No descriptor
// stays open except that of the lock.
#include "gateway/store/files.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>

namespace axisgate {
namespace {

class Descriptor {
public:
    explicit Descriptor(int fd) noexcept : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const noexcept { return fd_; }
    [[nodiscard]] int release() noexcept {
        const int fd = fd_;
        fd_ = -1;
        return fd;
    }

private:
    int fd_;
};

StoreFailure system_fail(std::string_view doing, const std::string& file, const std::string& directory) {
    const int e = errno;
    return fail(system_failure(fmt::format("{} {}", doing, file), e, directory));
}

/// An attempt only: a file system without owners (FAT) is no reason to fail.
void give_to_owner_of(int fd, const std::string& directory) noexcept {
    struct stat st {};
    if (::geteuid() == 0 && ::stat(directory.c_str(), &st) == 0 && (st.st_uid != 0 || st.st_gid != 0)) {
        [[maybe_unused]] const int r = ::fchown(fd, st.st_uid, st.st_gid);
    }
}

int fsync_retry(int fd) noexcept {
    int r = 0;
    do {
        r = ::fsync(fd);
    } while (r != 0 && errno == EINTR);
    return r;
}

bool write_all(int fd, const char* data, std::size_t n) noexcept {
    while (n > 0) {
        const ssize_t w = ::write(fd, data, n);
        if (w < 0) {
            if (errno == EINTR) continue;
            return false;
        }
        data += w;
        n -= static_cast<std::size_t>(w);
    }
    return true;
}

std::string absolute(const std::string& dir) {
    std::error_code ec;
    auto p = std::filesystem::absolute(dir.empty() ? "." : dir, ec);
    if (ec) return dir;
    p = p.lexically_normal();
    // "x/" and "x" are one directory; the form without the slash is kept.
    if (!p.has_filename() && p.has_relative_path()) p = p.parent_path();
    return p.string();
}

}  // namespace

StoreFiles::StoreFiles(const std::string& dir)
    : directory(absolute(dir)),
      database(directory + "/axisgate.db"),
      lock(directory + "/axisgate.lock"),
      fresh(database + ".new"),
      incoming(database + ".incoming"),
      restored(database + ".restored") {}

std::string StoreFiles::before(int version) const { return fmt::format("{}.before-{}", database, version); }
std::string StoreFiles::replaced(int number) const { return fmt::format("{}.replaced-{}", database, number); }

StoreResult<DirectoryLock> DirectoryLock::take(const StoreFiles& files) {
    Descriptor fd(::open(files.lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640));
    if (fd.get() < 0) return system_fail("cannot open the lock file", files.lock, files.directory);
    give_to_owner_of(fd.get(), files.directory);
    if (::flock(fd.get(), LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK) return system_fail("cannot lock", files.lock, files.directory);
        std::array<char, 32> text{};
        const ssize_t n = ::pread(fd.get(), text.data(), text.size(), 0);
        const std::string pid(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
        return fail(StoreError::Kind::in_use,
                    fmt::format("the data directory {} is in use by another axisgate{}. Stop that one first, or choose another directory "
                                "(--data DIR)",
                                files.directory, pid.empty() ? "" : " (process " + pid.substr(0, pid.find('\n')) + ")"));
    }
    // The number is only for people: the lock is the flock, so a stale number after a crash does no harm, and neither does a full disk.
    const std::string pid = fmt::format("{}\n", ::getpid());
    if (::ftruncate(fd.get(), 0) == 0) [[maybe_unused]]
        const bool written = write_all(fd.get(), pid.data(), pid.size());
    return DirectoryLock(fd.release());
}

DirectoryLock::~DirectoryLock() {
    if (fd_ >= 0) ::close(fd_);
}

namespace files {

StoreResult<> make_directory(const std::string& directory) {
    std::string made;
    std::size_t at = 0;
    do {
        at = directory.find('/', at + 1);
        made = directory.substr(0, at);
        if (::mkdir(made.c_str(), 0750) != 0 && errno != EEXIST) {
            // A read-only parent that exists causes EEXIST; EROFS and EACCES occur for missing ones.
            const int e = errno;
            if (!exists(made)) {
                errno = e;
                return system_fail("cannot make the data directory", made, std::filesystem::path(made).parent_path().string());
            }
        }
    } while (at != std::string::npos);
    struct stat st {};
    if (::stat(directory.c_str(), &st) != 0) return system_fail("cannot look at the data directory", directory, directory);
    if (!S_ISDIR(st.st_mode)) {
        return fail(StoreError::Kind::cannot_open,
                    fmt::format("{} is a file, not a directory. Choose another data directory (--data DIR)", directory));
    }
    return {};
}

StoreResult<> create(const std::string& file, const std::string& directory) {
    if (::unlink(file.c_str()) != 0 && errno != ENOENT) return system_fail("cannot replace", file, directory);
    const Descriptor fd(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0640));
    if (fd.get() < 0) return system_fail("cannot create", file, directory);
    if (::fchmod(fd.get(), 0640) != 0) return system_fail("cannot set the mode of", file, directory);  // independent of the umask
    give_to_owner_of(fd.get(), directory);
    return {};
}

StoreResult<> copy(const std::string& from, const std::string& to, const std::string& directory) {
    struct stat st {};
    const std::string folder =
        std::filesystem::path(from).has_parent_path() ? std::filesystem::path(from).parent_path().string() : "the folder that it is in";
    if (::stat(from.c_str(), &st) != 0) {
        if (errno == ENOENT)
            return fail(StoreError::Kind::cannot_open, fmt::format("there is no file {}. Name a backup that is there", from));
        return system_fail("cannot read", from, folder);
    }
    if (!S_ISREG(st.st_mode)) {  // checked first, because opening a pipe would wait for ever
        return fail(StoreError::Kind::cannot_open, fmt::format("{} is not a file. Name the backup file itself", from));
    }
    const Descriptor in(::open(from.c_str(), O_RDONLY | O_CLOEXEC));
    if (in.get() < 0) return system_fail("cannot read", from, folder);
    if (auto r = create(to, directory); !r) return r;
    const Descriptor out(::open(to.c_str(), O_WRONLY | O_CLOEXEC));
    if (out.get() < 0) return system_fail("cannot write", to, directory);
    std::array<char, 65536> buffer;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by read
    for (;;) {
        const ssize_t n = ::read(in.get(), buffer.data(), buffer.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return system_fail("cannot read", from, directory);
        if (n == 0) break;
        if (!write_all(out.get(), buffer.data(), static_cast<std::size_t>(n))) return system_fail("cannot write", to, directory);
    }
    if (fsync_retry(out.get()) != 0) return system_fail("cannot write", to, directory);
    return {};
}

StoreResult<> sync(const std::string& file, const std::string& directory) {
    const Descriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (fd.get() < 0 || fsync_retry(fd.get()) != 0) return system_fail("cannot write", file, directory);
    return {};
}

StoreResult<> sync_directory(const std::string& directory) {
    const Descriptor fd(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (fd.get() < 0) return system_fail("cannot open", directory, directory);
    // Some file systems (FAT, some network ones) have no fsync of a directory; there is no alternative on them.
    if (fsync_retry(fd.get()) != 0 && errno != EINVAL && errno != EROFS) return system_fail("cannot write", directory, directory);
    return {};
}

StoreResult<> rename(const std::string& from, const std::string& to, const std::string& directory) {
    if (::rename(from.c_str(), to.c_str()) != 0) return system_fail(fmt::format("cannot rename {} to", from), to, directory);
    return sync_directory(directory);
}

void remove_database(const std::string& file) noexcept {
    for (const char* suffix : {"", "-wal", "-shm", "-journal"})
        ::unlink((file + suffix).c_str());
}

bool exists(const std::string& file) noexcept {
    struct stat st {};
    return ::stat(file.c_str(), &st) == 0;
}

bool has_sqlite_header(const std::string& file) noexcept {
    constexpr std::string_view wanted("SQLite format 3\0", 16);
    std::array<char, 16> head{};
    const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    const bool whole = fd >= 0 && ::read(fd, head.data(), head.size()) == static_cast<ssize_t>(head.size());
    if (fd >= 0) ::close(fd);
    return whole && std::string_view(head.data(), head.size()) == wanted;
}

std::int64_t size(const std::string& file) noexcept {
    struct stat st {};
    return ::stat(file.c_str(), &st) == 0 ? static_cast<std::int64_t>(st.st_size) : -1;
}

bool is_read_only(const std::string& path) noexcept {
    struct statvfs st {};
    return ::statvfs(path.c_str(), &st) == 0 && (st.f_flag & ST_RDONLY) != 0;
}

bool same(const std::string& a, const std::string& b) noexcept {
    struct stat x {};
    struct stat y {};
    return ::stat(a.c_str(), &x) == 0 && ::stat(b.c_str(), &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

}  // namespace files
}  // namespace axisgate
