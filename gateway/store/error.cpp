// The texts of the store's errors in one place, so that a full disk has the same text in every function: the cause, then the remedy. They
// do not depend on the locale: the texts of errno are those of the C library's table.
#include "gateway/store/error.hpp"

#include <fmt/core.h>
#include <sqlite3.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace axisgate {
namespace {
using Kind = StoreError::Kind;

std::string errno_text(int system) { return system == 0 ? std::string() : std::generic_category().message(system); }

Kind kind_of_errno(int system, Kind otherwise) {
    switch (system) {
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
            return Kind::disk_full;
        case EROFS:
            return Kind::read_only;
        case EACCES:
        case EPERM:
        case ENOENT:
        case ENOTDIR:
        case EISDIR:
        case ELOOP:
        case ENAMETOOLONG:
        case EMFILE:
        case ENFILE:
            return Kind::cannot_open;
        case EIO:
            return Kind::io;
        default:
            return otherwise;
    }
}

Kind kind_of_sqlite(int extended, int system) {
    if (extended == SQLITE_IOERR_CORRUPTFS) return Kind::io;
    switch (extended & 0xFF) {
        case SQLITE_FULL:
            return Kind::disk_full;
        case SQLITE_IOERR:
            return kind_of_errno(system, Kind::io) == Kind::cannot_open ? Kind::io : kind_of_errno(system, Kind::io);
        case SQLITE_READONLY:
            return Kind::read_only;
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            return Kind::busy;
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB:
            return Kind::corrupt;
        case SQLITE_CANTOPEN: {
            const Kind k = kind_of_errno(system, Kind::cannot_open);
            return k == Kind::io ? Kind::cannot_open : k;
        }
        case SQLITE_PERM:
        case SQLITE_AUTH:
            return Kind::cannot_open;
        case SQLITE_TOOBIG:
        case SQLITE_CONSTRAINT:
            return Kind::invalid;
        default:
            return Kind::internal;
    }
}

/// The cause in plain words, and the remedy.
std::string sentence(Kind kind, const StorePlace& place) {
    switch (kind) {
        case Kind::disk_full:
            if (place.at_size_limit) {
                return fmt::format(
                    "the database has reached its size limit of {} bytes. Delete snapshots or raise the limit; it takes writes again as "
                    "soon "
                    "as there is room",
                    place.max_bytes);
            }
            return fmt::format(
                "the disk is full. Free space on the file system of {}, then repeat it; the database takes writes again by itself",
                place.directory);
        case Kind::io:
            return fmt::format(
                "the disk or file system of {} failed. Look into the kernel's log (dmesg), take a backup, and replace the disk if it is "
                "failing; the database is tried again with every write",
                place.directory);
        case Kind::read_only:
            return fmt::format(
                "{} cannot be written. If its file system is mounted read only (often after a disk error, see dmesg), mount it for "
                "writing; "
                "else give the service's user the right to write there",
                place.file);
        case Kind::busy:
            return fmt::format("another program holds {} locked. Close it (an sqlite3 shell?), then repeat it", place.file);
        case Kind::corrupt:
            return fmt::format(
                "{} is damaged or not a database. Stop the service and restore a backup with `axisgate restore FILE`; the damaged file is "
                "left "
                "as it is, and kept beside the restored one",
                place.file);
        case Kind::cannot_open:
            return fmt::format("{} cannot be opened. Make sure that the folder exists and that the service's user may read and write in it",
                               place.file);
        case Kind::invalid:
            return "the database refuses it because it breaks a rule of its structure. Please report this";
        default:
            return "unexpected answer of the database. Please report this";
    }
}
}  // namespace

std::string_view name_of(StoreError::Kind kind) noexcept {
    constexpr std::array names{"disk_full", "io",          "read_only", "busy",     "in_use",  "corrupt", "newer",
                               "not_ours",  "cannot_open", "not_found", "conflict", "invalid", "internal"};
    return names[static_cast<std::size_t>(kind)];
}

StoreError sqlite_failure(int extended, int system, std::string_view message, const StorePlace& place) {
    StoreError e;
    e.kind = kind_of_sqlite(extended, system);
    e.sqlite_code = extended;
    e.text = fmt::format("{} (SQLite {}: {}{}{})", sentence(e.kind, place), extended, message, system != 0 ? "; " : "", errno_text(system));
    return e;
}

StoreError system_failure(std::string_view what, int system, const std::string& directory) {
    StoreError e;
    e.kind = kind_of_errno(system, Kind::io);
    std::string remedy;
    switch (e.kind) {
        case Kind::disk_full:
            remedy = fmt::format("Free space on the file system of {}, then repeat it", directory);
            break;
        case Kind::read_only:
            remedy = fmt::format("Mount the file system of {} for writing, then repeat it", directory);
            break;
        case Kind::cannot_open:
            remedy = fmt::format("Make sure that {} exists and that the service's user may read and write in it", directory);
            break;
        default:
            remedy = "Look into the kernel's log (dmesg), then repeat it";
            break;
    }
    e.text = fmt::format("{}: {}. {}", what, errno_text(system), remedy);
    return e;
}

}  // namespace axisgate
