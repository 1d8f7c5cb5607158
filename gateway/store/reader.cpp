// StoreReader: opening, site, twins, documents, the file itself. Each list is bounded by its table's own bound.
#include "gateway/store/reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "gateway/store/backup.hpp"

namespace axisgate {

StoreResult<std::unique_ptr<StoreReader>> StoreReader::open(const StoreOptions& options) {
    std::unique_ptr<StoreReader> reader(new StoreReader(options));
    const StoreFiles& files = reader->files_;
    if (!files::exists(files.database)) {
        return fail(
            StoreError::Kind::not_found,
            fmt::format("there is no database {}. Start the service once, or name its data directory (--data DIR)", files.database));
    }
    auto db = Db::open(files.database, Db::Mode::read_only, options.vfs);
    if (!db) return fail(db);
    reader->db_ = std::move(*db);
    const int newest = static_cast<int>(options.migrations.size());
    if (auto r = check_identity(*reader->db_, newest); !r) return fail(r);
    const auto version = version_of(*reader->db_);
    if (!version) return fail(version);
    if (*version != newest) {
        return fail(StoreError::Kind::invalid,
                    fmt::format("{} is of version {}, this program needs version {}. Start the service once: it upgrades it",
                                files.database, *version, newest));
    }
    return reader;
}

// --- site -------------------------------------------------------------------------------------------------------------------

namespace {
SiteRevision revision_of(const Query& q) {
    SiteRevision s;
    s.revision = static_cast<std::uint64_t>(q.integer(0));
    s.at_unix_ns = q.integer(1);
    s.who = q.text(2);
    s.bytes = static_cast<std::uint64_t>(q.integer(3));
    return s;
}
StoreResult<std::optional<SiteRevision>> one_revision(Query& q) {
    const auto row = q.row();
    if (!row) return fail(row, "the site could not be read");
    if (!*row) return std::nullopt;
    SiteRevision s = revision_of(q);
    s.text = q.text(4);
    return s;
}
}  // namespace

StoreResult<std::optional<SiteRevision>> StoreReader::load_site() {
    Query q(*db_, "SELECT id, at_unix_ns, who, bytes, text FROM site_revision ORDER BY id DESC LIMIT 1");
    return one_revision(q);
}

StoreResult<std::optional<SiteRevision>> StoreReader::site(std::uint64_t revision) {
    Query q(*db_, "SELECT id, at_unix_ns, who, bytes, text FROM site_revision WHERE id = ?");
    q.bind(static_cast<std::int64_t>(revision));
    return one_revision(q);
}

StoreResult<std::vector<SiteRevision>> StoreReader::site_history(std::size_t limit, std::uint64_t before) {
    std::vector<SiteRevision> list;
    Query q(*db_, "SELECT id, at_unix_ns, who, bytes FROM site_revision WHERE id < ? ORDER BY id DESC LIMIT ?");
    constexpr auto all = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    q.bind(static_cast<std::int64_t>(before == 0 ? all : std::min(before, all)));
    q.bind(static_cast<std::int64_t>(std::clamp<std::size_t>(limit, 1, max_answer_rows)));
    for (;;) {
        const auto row = q.row();
        if (!row) return fail(row, "the history of the site could not be read");
        if (!*row) return list;
        list.push_back(revision_of(q));
    }
}

// --- twins ------------------------------------------------------------------------------------------------------------------

StoreResult<NonVolatile> StoreReader::load_twin(std::string_view drive) {
    NonVolatile memory;
    Query q(*db_, "SELECT name, value_type, value FROM twin_memory WHERE drive = ? ORDER BY name");
    q.bind(drive);
    for (;;) {
        const auto row = q.row();
        if (!row) return fail(row, fmt::format("memory of the twin of drive {} could not be read", drive));
        if (!*row) return memory;
        auto value = q.value(1);
        if (!value) return fail(value, fmt::format("memory of the twin of drive {}, {}", drive, q.text(0)));
        memory.emplace_hint(memory.end(), q.text(0), std::move(*value));
    }
}

// --- documents --------------------------------------------------------------------------------------------------------------

namespace {
StoreDocument document_of(const Query& q) { return {q.text(0), q.text(1), q.text(2), q.text(3), q.integer(4)}; }
}  // namespace

StoreResult<std::optional<StoreDocument>> StoreReader::document(std::string_view kind, std::string_view name) {
    Query q(*db_, "SELECT kind, name, text, who, at_unix_ns FROM document WHERE kind = ? AND name = ?");
    q.bind(kind).bind(name);
    const auto row = q.row();
    if (!row) return fail(row, fmt::format("{} {} could not be read", kind, name));
    if (!*row) return std::nullopt;
    return document_of(q);
}

StoreResult<std::vector<StoreDocument>> StoreReader::documents(std::string_view kind) {
    std::vector<StoreDocument> list;
    Query q(*db_, "SELECT kind, name, text, who, at_unix_ns FROM document WHERE kind = ? ORDER BY name");
    q.bind(kind);
    for (;;) {
        const auto row = q.row();
        if (!row) return fail(row, fmt::format("documents of kind {} could not be read", kind));
        if (!*row) return list;
        list.push_back(document_of(q));
    }
}

// --- descriptions -----------------------------------------------------------------------------------------------------------

StoreResult<std::vector<StoredDescription>> StoreReader::descriptions() {
    std::vector<StoredDescription> list;
    Query q(*db_, "SELECT name, text, who, at_unix_ns FROM description ORDER BY name");
    for (;;) {
        const auto row = q.row();
        if (!row) return fail(row, "the descriptions of drives could not be read");
        if (!*row) return list;
        list.push_back({q.text(0), q.text(1), q.text(2), q.integer(3)});
    }
}

// --- the file ---------------------------------------------------------------------------------------------------------------

StoreResult<> StoreReader::check() {
    if (auto r = check_soundness(*db_, true); !r) return r;
    return check_structure(*db_, options_.migrations);
}

StoreResult<StoreFacts> StoreReader::facts() {
    StoreFacts f;
    f.file = files_.database;
    std::int64_t page = 0;
    const auto read = [&](const char* sql, auto& into) -> StoreResult<> {
        const auto v = db_->integer(sql);
        if (!v) return fail(v, "the state of the database could not be read");
        into = static_cast<std::remove_reference_t<decltype(into)>>(*v);
        return {};
    };
    if (auto r = read("PRAGMA page_size", page); !r) return fail(r);
    if (auto r = read("PRAGMA page_count", f.bytes); !r) return fail(r);
    if (auto r = read("PRAGMA freelist_count", f.free_bytes); !r) return fail(r);
    if (auto r = read("PRAGMA user_version", f.version); !r) return fail(r);
    if (auto r = read("SELECT count(*) FROM parameter_write", f.parameter_writes); !r) return fail(r);
    if (auto r = read("SELECT count(*) FROM event", f.events); !r) return fail(r);
    f.bytes *= static_cast<std::uint64_t>(page);
    f.free_bytes *= static_cast<std::uint64_t>(page);
    const std::int64_t wal = files::size(files_.database + "-wal");
    f.wal_bytes = wal > 0 ? static_cast<std::uint64_t>(wal) : 0;
    return f;
}

StoreResult<> StoreReader::backup(const std::string& target) { return backup_database(files_.directory, target); }

}  // namespace axisgate
