// Opens a store: directory, lock, first database, checks, upgrade, settings. Nothing is written to a database before it was found to be
// axisgate's, not newer, sound and complete.
#include "gateway/store/store.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/store/backup.hpp"

namespace axisgate {
namespace {
using Kind = StoreError::Kind;
constexpr const char* journal_bound = "PRAGMA journal_size_limit=16777216";  // the log shrinks to this size after a burst
}  // namespace

StoreResult<std::unique_ptr<Store>> Store::open(const StoreOptions& options) {
    if (options.migrations.empty()) return fail(Kind::internal, "the store was given no migrations. Please report this");
    std::unique_ptr<Store> store(new Store(options));
    const StoreFiles& files = store->files_;
    if (auto r = files::make_directory(files.directory); !r) return fail(r);
    auto lock = DirectoryLock::take(files);
    if (!lock) return fail(lock);
    store->lock_.emplace(std::move(*lock));
    if (auto r = finish_restore(files); !r) return fail(r, "a restore that was begun could not be finished");
    if (!files::exists(files.database)) {
        for (const char* suffix : {"-wal", "-journal"}) {
            if (files::size(files.database + suffix) > 0) {
                return fail(
                    Kind::corrupt,
                    fmt::format("{} is missing, but its log {}{} is there: the file was removed or lost. Restore a backup with `axisgate "
                                "restore FILE`, or move the log away to begin with an empty database",
                                files.database, files.database, suffix));
            }
        }
        if (auto r = store->create_database(); !r) return fail(r, "no database could be made");
    }
    if (auto r = store->open_database(); !r) return fail(r);
    return store;
}

Store::~Store() = default;

StoreResult<> Store::create_database() {
    // Under another name until it is complete: an empty axisgate.db is never made by axisgate, so that it can be distinguished from a lost
    // one.
    auto made = [&]() -> StoreResult<> {
        if (auto r = files::create(files_.fresh, files_.directory); !r) return r;
        auto db = Db::open(files_.fresh, Db::Mode::read_write, options_.vfs);
        if (!db) return fail(db);
        return migrate(**db, options_.migrations);
    }();
    if (!made) {
        files::remove_database(files_.fresh);
        return made;
    }
    if (auto r = files::sync(files_.fresh, files_.directory); !r) return r;
    return files::rename(files_.fresh, files_.database, files_.directory);
}

StoreResult<> Store::open_database() {
    if (files::size(files_.database) == 0) {
        return fail(Kind::corrupt,
                    fmt::format("{} is empty: its content was lost, or another program made it. Restore a backup with `axisgate "
                                "restore FILE`, or remove it to begin with an empty database",
                                files_.database));
    }
    auto db = Db::open(files_.database, Db::Mode::read_write, options_.vfs);
    if (!db) return fail(db);
    db_ = std::move(*db);
    if (options_.between) db_->between(steps_between, options_.between);
    if (sqlite3_db_readonly(db_->handle(), "main") == 1) {  // SQLite opens the file for reading if it may not write
        return fail(Kind::read_only,
                    fmt::format("{} cannot be written. Give the service's user the right to write it, or mount its file system for "
                                "writing",
                                files_.database));
    }
    const int newest = static_cast<int>(options_.migrations.size());
    if (auto r = check_identity(*db_, newest); !r) return r;
    if (auto r = check_soundness(*db_, false); !r) return r;
    if (auto r = check_structure(*db_, options_.migrations); !r) return r;
    const auto version = version_of(*db_);
    if (!version) return fail(version);
    if (*version < newest) {
        if (auto r = copy_before_upgrade(); !r) return fail(r, fmt::format("{} was not upgraded, nothing changed", files_.database));
    }
    if (auto r = settle(); !r) return r;
    if (*version < newest) {
        if (auto r = migrate(*db_, options_.migrations); !r) {
            return fail(r, fmt::format("the upgrade of {} failed (a copy from before is {})", files_.database, files_.before(newest)));
        }
    }
    return forget_empty_axes();
}

StoreResult<> Store::copy_before_upgrade() {
    const std::string target = files_.before(static_cast<int>(options_.migrations.size()));
    const std::string part = target + ".part";
    auto made = [&]() -> StoreResult<> {
        if (auto r = files::create(part, files_.directory); !r) return r;
        if (auto r = Query(*db_, "VACUUM INTO ?").bind(part).run(); !r) return r;
        if (auto r = files::sync(part, files_.directory); !r) return r;
        return files::rename(part, target, files_.directory);
    }();
    if (!made) files::remove_database(part);
    return made;
}

StoreResult<> Store::settle() {
    const auto mode = db_->text("PRAGMA journal_mode=WAL");
    if (!mode) return fail(mode);
    if (*mode != "wal") {
        return fail(
            Kind::cannot_open,
            fmt::format("the file system of {} cannot share memory between programs, which the write-ahead log needs. Choose a data "
                        "directory on a local disk (--data DIR)",
                        files_.directory));
    }
    if (auto r = db_->exec("PRAGMA synchronous=FULL; PRAGMA wal_autocheckpoint=1000"); !r) return r;
    if (auto r = db_->exec(journal_bound); !r) return r;
    if (options_.limits.max_bytes != 0) {
        const auto page = db_->integer("PRAGMA page_size");
        if (!page) return fail(page);
        const std::uint64_t pages = std::max<std::uint64_t>(options_.limits.max_bytes / static_cast<std::uint64_t>(*page), 1);
        const std::uint64_t most = 0xFFFFFFFE;
        if (auto r = db_->exec(fmt::format("PRAGMA max_page_count={}", std::min(pages, most)).c_str()); !r) return r;
        db_->set_max_bytes(options_.limits.max_bytes);
    }
    // The checks have passed: from now on the log may be merged when it is closed.
    sqlite3_db_config(db_->handle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 0, nullptr);
    return {};
}

StoreResult<> Store::forget_empty_axes() {
    // A full disk must not prevent the start of the gateway: this is maintenance, and the next start tries again.
    auto done = db_->transaction([&] {
        return Query(*db_,
                     "DELETE FROM axis WHERE removed_unix_ns IS NOT NULL AND NOT EXISTS (SELECT 1 FROM parameter_write w WHERE w.axis_id = "
                     "axis.id) "
                     "AND NOT EXISTS (SELECT 1 FROM parameter_stored p WHERE p.axis_id = axis.id) "
                     "AND NOT EXISTS (SELECT 1 FROM snapshot s WHERE s.axis_id = axis.id)")
            .run();
    });
    if (!done && done.error().kind == Kind::corrupt) return done;
    return {};
}

StoreResult<> Store::tidy() {
    auto pruned = db_->transaction([&] { return prune(0, 0); });
    if (!pruned) return fail(pruned, "old rows could not be removed");
    if (auto r = Query(*db_, "PRAGMA wal_checkpoint(PASSIVE)").run(); !r) return fail(r, "the log could not be moved into the database");
    return {};
}

StoreResult<> Store::prune(std::size_t writes_added, std::size_t events_added) {
    // Ids have no relevant gaps, so their range is the count. As many rows are deleted as were added, and one piece more while over the
    // bound.
    const auto piece = options_.limits.piece;
    if (auto r = Query(*db_,
                       "DELETE FROM parameter_write WHERE id <= min((SELECT max(id) FROM parameter_write) - ?, "
                       "(SELECT min(id) FROM parameter_write) + ? - 1)")
                     .bind(static_cast<std::int64_t>(options_.limits.parameter_writes))
                     .bind(static_cast<std::int64_t>(writes_added + piece))
                     .run();
        !r) {
        return r;
    }
    return Query(*db_, "DELETE FROM event WHERE id <= min((SELECT max(id) FROM event) - ?, (SELECT min(id) FROM event) + ? - 1)")
        .bind(static_cast<std::int64_t>(options_.limits.events))
        .bind(static_cast<std::int64_t>(events_added + piece))
        .run();
}

}  // namespace axisgate
