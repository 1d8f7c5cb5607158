// Backup (VACUUM INTO a temporary file, check, rename) and restore (copy, check, replace). A copy is always read back and checked before it
// is used.
#include "gateway/store/backup.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>

#include "gateway/store/files.hpp"
#include "gateway/store/migrate.hpp"
#include "gateway/store/sqlite.hpp"

namespace axisgate {
namespace {
using Kind = StoreError::Kind;

struct Target {
    std::string file;
    std::string directory;
};

StoreResult<Target> target_of(const std::string& target, const StoreFiles& files) {
    std::error_code ec;
    const auto path = std::filesystem::absolute(target, ec).lexically_normal();
    if (ec || target.empty() || !path.has_filename()) return fail(Kind::invalid, "name the file that shall hold the backup");
    Target t{path.string(), path.parent_path().string()};
    if (std::filesystem::is_directory(path, ec)) {
        return fail(Kind::invalid, fmt::format("{} is a directory. Name the file that shall hold the backup, such as {}/axisgate-backup.db",
                                               t.file, t.file));
    }
    const std::string name = path.filename().string();
    const bool own_name = name.starts_with("axisgate.db") || name == "axisgate.lock";
    if ((own_name && files::same(t.directory, files.directory)) || files::same(t.file, files.database)) {
        return fail(Kind::invalid, fmt::format("{} is one of the database's own files. Choose another name for the backup", t.file));
    }
    return t;
}

/// The path to which the database that is about to be replaced is moved.
StoreResult<std::string> place_aside(const StoreFiles& files) {
    for (int number = 1; number <= 99; ++number) {
        if (!files::exists(files.replaced(number))) return files.replaced(number);
    }
    return fail(Kind::conflict,
                fmt::format("{} and 98 more replaced databases are still kept. Remove those that are no longer needed", files.replaced(1)));
}

/// Opens a copy that no other program knows and checks whether it is a complete database of axisgate.
StoreResult<int> check_copy(const std::string& file, std::span<const Migration> migrations, int newest) {
    if (files::size(file) == 0) return fail(Kind::corrupt, fmt::format("{} is empty. Name a backup that holds a database", file));
    // Read-write, because a copy of a live file may have its log beside it, which is merged here.
    auto db = Db::open(file, Db::Mode::read_write);
    if (!db) return fail(db);
    if (auto r = check_identity(**db, newest); !r) return fail(r);
    if (auto r = check_soundness(**db, true); !r) return fail(r);
    if (!migrations.empty()) {
        if (auto r = check_structure(**db, migrations); !r) return fail(r);
    }
    return version_of(**db);
}

}  // namespace

StoreResult<> check_backup_target(const std::string& directory, const std::string& target) {
    const auto to = target_of(target, StoreFiles(directory));
    if (!to) return fail(to, "no backup made");
    return {};
}

StoreResult<> backup_database(const std::string& directory, const std::string& target) {
    const StoreFiles files(directory);
    if (!files::exists(files.database)) {
        return fail(Kind::not_found,
                    fmt::format("there is no database {} to back up. Name the service's data directory (--data DIR)", files.database));
    }
    const auto to = target_of(target, files);
    if (!to) return fail(to, "no backup made");
    static std::atomic<unsigned> count{0};  // two simultaneous backups to one name must not share their unfinished file
    const std::string part = fmt::format("{}.{}-{}.part", to->file, ::getpid(), ++count);
    const std::string copied = part + ".source.part";
    const auto made = [&]() -> StoreResult<> {
        // On a read-only file system SQLite cannot open a database with a log. No program writes there, so a copy of its files is
        // consistent.
        const bool frozen = files::is_read_only(files.directory) && !files::same(files.directory, to->directory);
        if (frozen) {
            for (const char* suffix : {"", "-wal"}) {
                if (!files::exists(files.database + suffix)) continue;
                if (auto r = files::copy(files.database + suffix, copied + suffix, to->directory); !r) return r;
            }
        }
        auto db = frozen ? Db::open(copied, Db::Mode::read_write) : Db::open(files.database, Db::Mode::read_only);
        if (!db) return fail(db);
        const auto version = version_of(**db);
        if (!version) return fail(version);
        if (auto r = check_identity(**db, *version); !r) return r;  // any version can be backed up, but only a database of axisgate
        if (auto r = files::create(part, to->directory); !r) return r;
        {
            Query vacuum(**db, "VACUUM INTO ?");
            if (auto r = vacuum.bind(part).run(); !r) return r;
        }
        if (auto r = check_copy(part, {}, *version); !r) return fail(r, "the copy is not good");
        if (auto r = files::sync(part, to->directory); !r) return r;
        return files::rename(part, to->file, to->directory);
    }();
    files::remove_database(copied);
    if (!made) {
        files::remove_database(part);
        return fail(made, fmt::format("no backup made to {}", to->file));
    }
    return {};
}

/// The site revision in a database that is about to be replaced; 0: none, or it cannot be read. Leaves no files behind.
static std::uint64_t revision_in(const std::string& database) {
    if (!files::exists(database)) return 0;
    const bool had_log = files::exists(database + "-wal");
    std::uint64_t revision = 0;
    if (auto old = Db::open(database, Db::Mode::read_only)) {
        if (const auto newest = (*old)->integer("SELECT ifnull(max(id), 0) FROM site_revision"))
            revision = static_cast<std::uint64_t>(*newest);
    }
    if (!had_log) {
        (void)::unlink((database + "-wal").c_str());
        (void)::unlink((database + "-shm").c_str());
    }
    return revision;
}

StoreResult<RestoreReport> restore_database(const std::string& source, const StoreOptions& options) {
    const StoreFiles files(options.directory);
    const auto failed = [&](const auto& r) { return fail(r, fmt::format("{} not restored, nothing was replaced", source)); };
    for (const std::string& own : {files.database, files.incoming, files.restored, files.fresh}) {
        if (files::same(source, own)) {
            return fail(Kind::invalid, fmt::format("{} is one of the database's own files. Name a backup file", source));
        }
    }
    if (auto r = files::make_directory(files.directory); !r) return failed(r);
    const auto lock = DirectoryLock::take(files);
    if (!lock) return failed(lock);
    if (auto r = finish_restore(files); !r) return failed(r);
    if (auto r = place_aside(files); !r) return failed(r);  // before anything is copied

    std::uint64_t site_revision = 0;
    const auto checked = [&]() -> StoreResult<int> {
        if (auto r = files::copy(source, files.incoming, files.directory); !r) return fail(r);
        // A copy that was taken by hand of a live database has its newest rows in the log beside it.
        if (files::size(source + "-wal") > 0) {
            if (auto r = files::copy(source + "-wal", files.incoming + "-wal", files.directory); !r) return fail(r);
        }
        const int newest = static_cast<int>(options.migrations.size());
        auto version = check_copy(files.incoming, options.migrations, newest);
        if (!version) {
            // The message concerns the copy, which is about to be deleted; the user knows the source.
            StoreError e = version.error();
            for (std::size_t at = e.text.find(files.incoming); at != std::string::npos; at = e.text.find(files.incoming)) {
                e.text.replace(at, files.incoming.size(), source);
            }
            return fail(std::move(e));
        }
        // Everything is merged into one file, which needs no other file from here on.
        auto db = Db::open(files.incoming, Db::Mode::read_write);
        if (!db) return fail(db);
        if (auto r = (*db)->exec("PRAGMA journal_mode=DELETE"); !r) return fail(r);
        const auto newest_site = (*db)->integer("SELECT ifnull(max(id), 0) FROM site_revision");
        if (!newest_site) return fail(newest_site);
        site_revision = static_cast<std::uint64_t>(*newest_site);
        return version;
    }();
    if (!checked) {
        files::remove_database(files.incoming);
        return failed(checked);
    }
    if (auto r = files::sync(files.incoming, files.directory); !r) return failed(r);
    if (auto r = files::rename(files.incoming, files.restored, files.directory); !r) return failed(r);
    const std::uint64_t replaced = revision_in(files.database);
    const auto kept = finish_restore(files);
    if (!kept) return fail(kept, fmt::format("{} is good, but did not take its place yet; the next start tries again", source));
    return RestoreReport{*kept, *checked, site_revision, replaced};
}

StoreResult<std::string> finish_restore(const StoreFiles& files) {
    files::remove_database(files.fresh);
    files::remove_database(files.incoming);
    if (!files::exists(files.restored)) return std::string();
    // Each step can be the last before a crash: the log is moved before its database, so that the same number is found again, and the
    // restored file replaces the database only when no file of the old one is left.
    auto place = place_aside(files);
    if (!place) return place;
    const std::string& aside = *place;
    const bool old = files::exists(files.database);
    const std::string wal = files.database + "-wal";
    if (files::exists(wal)) {
        if (auto r = files::rename(wal, aside + "-wal", files.directory); !r) return fail(r);
    }
    ::unlink((files.database + "-shm").c_str());
    if (old) {
        if (auto r = files::rename(files.database, aside, files.directory); !r) return fail(r);
    }
    if (auto r = files::rename(files.restored, files.database, files.directory); !r) return fail(r);
    return old ? aside : std::string();
}

}  // namespace axisgate
