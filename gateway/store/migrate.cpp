// Migrates a file, and checks a file before it is used. Nothing is written before the checks have passed.
#include "gateway/store/migrate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "gateway/store/files.hpp"

namespace axisgate {
namespace {
using Kind = StoreError::Kind;

/// One line per column of a table and per index: the required structure.
StoreResult<std::vector<std::string>> structure(Db& db) {
    std::vector<std::string> lines;
    Query columns(db,
                  "SELECT 'column ' || c.name || ' ' || c.type || ' of table ' || t.name FROM sqlite_schema t, pragma_table_info(t.name) c "
                  "WHERE t.type = 'table' AND t.name NOT LIKE 'sqlite%' "
                  "UNION ALL SELECT 'index ' || name FROM sqlite_schema WHERE type = 'index' AND sql IS NOT NULL");
    for (;;) {
        const auto row = columns.row();
        if (!row) return fail(row);
        if (!*row) break;
        lines.push_back(columns.text(0));
    }
    std::sort(lines.begin(), lines.end());
    return lines;
}

}  // namespace

StoreResult<std::vector<Migration>> migrations_among(std::span<const Asset> assets) {
    constexpr std::string_view folder = "schema/sql/";
    std::vector<Migration> found;
    for (const Asset& a : assets) {
        if (!a.path.starts_with(folder) || !a.path.ends_with(".sql")) continue;
        const std::string_view name = a.path.substr(folder.size());
        Migration m;
        const auto [end, ec] = std::from_chars(name.data(), name.data() + name.size(), m.number);
        if (ec != std::errc() || end == name.data() + name.size() || *end != '_') {
            return fail(Kind::internal, fmt::format("{}: a migration's name begins with its number and '_' (0001_base.sql)", a.path));
        }
        m.name = std::string(name);
        m.sql = a.bytes;
        found.push_back(std::move(m));
    }
    std::sort(found.begin(), found.end(), [](const Migration& a, const Migration& b) { return a.number < b.number; });
    if (found.empty()) return fail(Kind::internal, "this program was built without its migrations (schema/sql). Build it again");
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (found[i].number != static_cast<int>(i) + 1) {
            return fail(Kind::internal, fmt::format("migrations must be numbered 1, 2, 3, ...: {} is at place {}. Build the program again",
                                                    found[i].name, i + 1));
        }
    }
    return found;
}

StoreResult<int> version_of(Db& db) {
    const auto v = db.integer("PRAGMA user_version");
    if (!v) return fail(v);
    return static_cast<int>(*v);
}

StoreResult<> check_identity(Db& db, int newest) {
    const auto id = db.integer("PRAGMA application_id");
    if (!id) return fail(id);
    if (*id != application_id) {
        // SQLite takes a file that is shorter than a page for an empty database.
        if (!files::has_sqlite_header(db.file())) {
            return fail(
                Kind::corrupt,
                fmt::format("{} is not a database. Name a file that `axisgate backup` made; if it lies in the place of the database, "
                            "move it away and restore a backup with `axisgate restore FILE`",
                            db.file()));
        }
        return fail(Kind::not_ours,
                    fmt::format("{} is a SQLite file, but not one of axisgate. Name the right file, or move this one away", db.file()));
    }
    const auto version = version_of(db);
    if (!version) return fail(version);
    if (*version > newest) {
        return fail(Kind::newer,
                    fmt::format("{} is of version {}, this program knows versions up to {}. Install the newer axisgate again, or "
                                "restore a backup of the older one with `axisgate restore FILE` ({}.before-{} if it was upgraded here)",
                                db.file(), *version, newest, db.file(), newest + 1));
    }
    return {};
}

StoreResult<> check_structure(Db& db, std::span<const Migration> migrations) {
    const auto version = version_of(db);
    if (!version) return fail(version);
    if (*version < 0 || static_cast<std::size_t>(*version) > migrations.size()) {
        return fail(Kind::newer, fmt::format("{} is of version {}, which this program does not know", db.file(), *version));
    }
    auto model = Db::open({}, Db::Mode::memory);
    if (!model) return fail(model);
    if (auto r = migrate(**model, migrations.first(static_cast<std::size_t>(*version))); !r) return r;
    const auto want = structure(**model);
    if (!want) return fail(want);
    const auto have = structure(db);
    if (!have) return fail(have);
    for (const std::string& line : *want) {
        if (!std::binary_search(have->begin(), have->end(), line)) {
            return fail(Kind::corrupt,
                        fmt::format("{} lacks its {}: another program has altered it. Restore a backup with `axisgate restore FILE`",
                                    db.file(), line));
        }
    }
    const auto triggers = db.integer("SELECT count(*) FROM sqlite_schema WHERE type = 'trigger'");
    if (!triggers) return fail(triggers);
    if (*triggers != 0) {
        return fail(Kind::corrupt,
                    fmt::format("{} has triggers, which axisgate never makes: another program has altered it. Remove them (DROP "
                                "TRIGGER) or restore a backup with `axisgate restore FILE`",
                                db.file()));
    }
    return {};
}

StoreResult<> check_soundness(Db& db, bool thorough) {
    const auto damaged = [&](const std::string& what) {
        return fail(Kind::corrupt,
                    fmt::format("{} is damaged ({}). Stop the service and restore a backup with `axisgate restore FILE`; the damaged "
                                "file is left as it is, and kept beside the restored one",
                                db.file(), what));
    };
    const auto answer = db.text(thorough ? "PRAGMA integrity_check(1)" : "PRAGMA quick_check(1)");
    if (!answer) return fail(answer);
    if (*answer != "ok") return damaged(*answer);
    if (thorough) {
        Query q(db, "SELECT \"table\", parent FROM pragma_foreign_key_check LIMIT 1");
        const auto row = q.row();
        if (!row) return fail(row);
        if (*row) return damaged(fmt::format("a row of {} refers to a missing row of {}", q.text(0), q.text(1)));
    }
    return {};
}

StoreResult<> migrate(Db& db, std::span<const Migration> migrations) {
    const auto version = version_of(db);
    if (!version) return fail(version);
    for (const Migration& m : migrations) {
        if (m.number <= *version) continue;
        auto done = db.transaction([&]() -> StoreResult<> {
            if (auto r = db.exec(std::string(m.sql).c_str()); !r) return r;
            if (!db.in_transaction()) return fail(Kind::internal, "the migration ends its transaction itself. Please report this");
            {
                Query broken(db, "SELECT \"table\" FROM pragma_foreign_key_check LIMIT 1");
                const auto row = broken.row();
                if (!row) return fail(row);
                if (*row)
                    return fail(Kind::internal, fmt::format("it breaks the references of table {}. Please report this", broken.text(0)));
            }
            return db.exec(fmt::format("PRAGMA user_version={}; PRAGMA application_id={}", m.number, application_id).c_str());
        });
        if (!done) return fail(done, fmt::format("step {} to version {} of {} was undone", m.name, m.number, db.file()));
    }
    return {};
}

}  // namespace axisgate
