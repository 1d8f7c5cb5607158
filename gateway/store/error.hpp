// The reason why the store could not do something: a kind for programs, and a text for people that includes the remedy. Errors are values;
// nothing here is thrown. The text is understandable without the error number.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace axisgate {

struct StoreError {
    enum class Kind : std::uint8_t {
        disk_full,    ///< no space on the file system, quota reached, or the database's own size limit; works again when there is space
        io,           ///< the disk or file system failed
        read_only,    ///< the file system or the file is not writable
        busy,         ///< another program holds the database for longer than the time-out
        in_use,       ///< another axisgate serves this data directory
        corrupt,      ///< the file is damaged or incomplete; a restore is necessary
        newer,        ///< written by a newer axisgate
        not_ours,     ///< a correct SQLite file, but not axisgate's
        cannot_open,  ///< missing permissions, a missing folder, a folder instead of a file
        not_found,    ///< the name does not exist
        conflict,     ///< the name is taken
        invalid,      ///< the request itself is wrong (too long, too many, duplicate)
        internal      ///< a fault of the gateway: please report it
    };
    Kind kind = Kind::internal;
    int sqlite_code = 0;  ///< SQLite's extended result code; 0 if SQLite was not involved
    std::string text;     ///< what happened, why, and the remedy
};
[[nodiscard]] std::string_view name_of(StoreError::Kind kind) noexcept;

/// The result of every call of the store: the value, or the error.
template <class T = void>
using StoreResult = tl::expected<T, StoreError>;
using StoreFailure = tl::unexpected<StoreError>;

[[nodiscard]] inline StoreFailure fail(StoreError::Kind kind, std::string text) {
    return StoreFailure(StoreError{kind, 0, std::move(text)});
}
[[nodiscard]] inline StoreFailure fail(StoreError error) { return StoreFailure(std::move(error)); }
/// Passes the failure of one call on as that of another, with `what` before it: "snapshot of axis feeder not saved: the disk is full ...".
template <class T>
[[nodiscard]] StoreFailure fail(const StoreResult<T>& failed, std::string_view what = {}) {
    StoreError e = failed.error();
    if (!what.empty()) e.text = std::string(what) + ": " + e.text;
    return StoreFailure(std::move(e));
}

/// The place of an error, for its remedy.
struct StorePlace {
    std::string directory;        ///< the data directory, or the folder of a backup
    std::string file;             ///< the database file
    bool at_size_limit = false;   ///< the database has reached its maximum number of pages (OpenOptions::max_bytes)
    std::uint64_t max_bytes = 0;  ///< that limit
};
/// The error of a SQLite call. `extended`: its extended result code; `system`: errno of the failed system call, 0 if none;
/// `message`: SQLite's own words.
[[nodiscard]] StoreError sqlite_failure(int extended, int system, std::string_view message, const StorePlace& place);
/// The error of a system call on a file: "cannot create /x/y: No space left on device. Free space ...".
[[nodiscard]] StoreError system_failure(std::string_view what, int system, const std::string& directory);

}  // namespace axisgate
