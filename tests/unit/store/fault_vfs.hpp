// A SQLite file layer between SQLite and the disk that fails on request, and that simulates the content after a power cut. Without a
// request nothing is changed. One test, one thread at a time.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace axisgate::test {

class FaultVfs {
public:
    enum Operation : unsigned { write = 1, sync = 2, truncate = 4, read = 8, open = 16, shared_memory = 32, size = 64, everything = 127 };

    FaultVfs();
    ~FaultVfs();
    FaultVfs(const FaultVfs&) = delete;
    FaultVfs& operator=(const FaultVfs&) = delete;
    [[nodiscard]] const std::string& name() const { return name_; }

    /// From the `after`-th such call on (0: the next one), `times` calls return `code` (for SQLITE_IOERR... with `system` as errno).
    void fail(unsigned operations, int code, int system = 0, std::uint64_t after = 0, std::uint64_t times = ~0ull);
    void heal();
    /// Calls of the failing kind since fail(), and how many of them failed.
    [[nodiscard]] std::uint64_t calls() const { return calls_; }
    [[nodiscard]] std::uint64_t failures() const { return failures_; }
    /// Opens files for reading only, as SQLite does on a file system that is mounted read only.
    void read_only(bool on) { read_only_ = on; }

    /// Starts the simulation: the present content of the directory's files is on the disk; later writes are not, until they are synced.
    void remember(const std::string& directory);
    /// Writes to `to` the content of the disk after a power cut now: everything synced, and of the later writes a random part, each
    /// complete, missing, or torn at a sector of 512 bytes.
    void power_cut(const std::string& to, std::mt19937& random) const;

    // For the C functions of the file layer.
    struct Pending {
        std::int64_t at = 0;
        std::string bytes;
        std::int64_t truncate_to = -1;  ///< >= 0: a truncation instead of a write
    };
    struct Disk {
        std::string synced;
        std::vector<Pending> pending;
    };
    [[nodiscard]] int verdict(Operation operation);
    void wrote(const std::string& file, Pending what);
    void synced(const std::string& file);
    void removed(const std::string& file);
    [[nodiscard]] bool is_read_only() const { return read_only_; }
    [[nodiscard]] int last_system() const { return system_; }
    sqlite3_vfs* base = nullptr;

private:
    std::string name_;
    sqlite3_vfs vfs_{};
    unsigned operations_ = 0;
    int code_ = 0;
    int system_ = 0;
    std::uint64_t after_ = 0;
    std::uint64_t times_ = 0;
    std::uint64_t calls_ = 0;
    std::uint64_t failures_ = 0;
    bool read_only_ = false;
    bool remembering_ = false;
    std::map<std::string, Disk> disk_;
};

}  // namespace axisgate::test
