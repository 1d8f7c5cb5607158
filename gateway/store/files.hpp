// Makes, locks, copies and renames files of the data directory; each operation is durable (fsync) when it returns. The live database is
// never opened here: closing a second descriptor of it would drop SQLite's locks (POSIX).
#pragma once

#include <cstdint>
#include <string>

#include "gateway/store/error.hpp"

namespace axisgate {

/// Names inside the data directory.
struct StoreFiles {
    explicit StoreFiles(const std::string& dir);
    std::string directory;  ///< absolute
    std::string database;   ///< axisgate.db
    std::string lock;       ///< axisgate.lock
    std::string fresh;      ///< axisgate.db.new: a first database before it is complete
    std::string incoming;   ///< axisgate.db.incoming: a backup that a restore is checking
    std::string restored;   ///< axisgate.db.restored: checked, replaces the database (also after a crash, at the next start)
    [[nodiscard]] std::string before(int version) const;   ///< the copy made before the upgrade to `version`
    [[nodiscard]] std::string replaced(int number) const;  ///< a database that a restore replaced, 1..99
};

/// Holds the data directory for this process; released when it ends, also by a crash.
class DirectoryLock {
public:
    [[nodiscard]] static StoreResult<DirectoryLock> take(const StoreFiles& files);
    DirectoryLock(DirectoryLock&& o) noexcept : fd_(o.fd_) { o.fd_ = -1; }
    DirectoryLock& operator=(DirectoryLock&&) = delete;
    DirectoryLock(const DirectoryLock&) = delete;
    DirectoryLock& operator=(const DirectoryLock&) = delete;
    ~DirectoryLock();

private:
    explicit DirectoryLock(int fd) noexcept : fd_(fd) {}
    int fd_;
};

namespace files {

/// Makes the directory and its missing parents, mode 0750. An existing one is not changed.
[[nodiscard]] StoreResult<> make_directory(const std::string& directory);
/// Makes an empty file, mode 0640, replacing an older one of that name. If root makes it, it belongs to the directory's owner, so that
/// `sudo axisgate restore` does not lock the service out.
[[nodiscard]] StoreResult<> create(const std::string& file, const std::string& directory);
[[nodiscard]] StoreResult<> copy(const std::string& from, const std::string& to, const std::string& directory);
[[nodiscard]] StoreResult<> sync(const std::string& file, const std::string& directory);
/// Renames within one directory and makes the new name durable.
[[nodiscard]] StoreResult<> rename(const std::string& from, const std::string& to, const std::string& directory);
[[nodiscard]] StoreResult<> sync_directory(const std::string& directory);
/// Removes a database's file together with its -wal, -shm and -journal; missing ones are ignored.
void remove_database(const std::string& file) noexcept;
[[nodiscard]] bool exists(const std::string& file) noexcept;
/// -1: the file does not exist.
[[nodiscard]] std::int64_t size(const std::string& file) noexcept;
/// True if it begins like every SQLite file that is not empty.
[[nodiscard]] bool has_sqlite_header(const std::string& file) noexcept;
/// True if its file system is mounted read-only.
[[nodiscard]] bool is_read_only(const std::string& path) noexcept;
/// True if both names are the same file (links, "..").
[[nodiscard]] bool same(const std::string& a, const std::string& b) noexcept;

}  // namespace files
}  // namespace axisgate
