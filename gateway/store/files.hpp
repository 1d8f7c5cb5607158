// Files of the data directory: making, locking, copying, renaming, each made durable (fsync) before it returns.
// In: paths. Out: done, or a StoreError with the system's reason.
// Never opens the live database: closing a second descriptor of it would drop SQLite's locks (POSIX).
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
    std::string fresh;      ///< axisgate.db.new: a first database before it is whole
    std::string incoming;   ///< axisgate.db.incoming: a backup that is being looked at by restore
    std::string restored;   ///< axisgate.db.restored: found good, takes the database's place (also after a crash, at the next start)
    [[nodiscard]] std::string before(int version) const;   ///< copy made before the upgrade to `version`
    [[nodiscard]] std::string replaced(int number) const;  ///< what a restore put aside, 1..99
};

/// Holds the data directory for this process; let go when it ends, also by a crash.
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

/// Makes the directory and what is missing above it, mode 0750. An existing one is left as it is.
[[nodiscard]] StoreResult<> make_directory(const std::string& directory);
/// Makes an empty file, mode 0640, in the place of an older one of that name. When root makes it, it belongs to the directory's owner:
/// `sudo axisgate restore` must not lock the service out.
[[nodiscard]] StoreResult<> create(const std::string& file, const std::string& directory);
[[nodiscard]] StoreResult<> copy(const std::string& from, const std::string& to, const std::string& directory);
[[nodiscard]] StoreResult<> sync(const std::string& file, const std::string& directory);
/// Renames within one directory and makes the new name durable.
[[nodiscard]] StoreResult<> rename(const std::string& from, const std::string& to, const std::string& directory);
[[nodiscard]] StoreResult<> sync_directory(const std::string& directory);
/// Removes a database's file together with its -wal, -shm and -journal; missing ones are passed over.
void remove_database(const std::string& file) noexcept;
[[nodiscard]] bool exists(const std::string& file) noexcept;
/// -1: there is none.
[[nodiscard]] std::int64_t size(const std::string& file) noexcept;
/// Whether it begins as every SQLite file does that is not empty.
[[nodiscard]] bool has_sqlite_header(const std::string& file) noexcept;
/// Whether the file system that it is on was mounted so that nobody can write.
[[nodiscard]] bool is_read_only(const std::string& path) noexcept;
/// The same file under any name (links, "..").
[[nodiscard]] bool same(const std::string& a, const std::string& b) noexcept;

}  // namespace files
}  // namespace axisgate
