// Opening, statements, transactions and values in pairs of columns, over SQLite's C interface. After an error no transaction stays open, so
// that a failed write does not prevent the next one.
#include "gateway/store/sqlite.hpp"

#include <fmt/core.h>

#include <bit>
#include <cerrno>
#include <filesystem>
#include <limits>

namespace axisgate {
namespace {
constexpr int busy_timeout_ms = 2000;  // other programs (an sqlite3 shell) may lock the file for a moment; readers never do

/// Settings that make a foreign file harmless and mistakes visible.
void harden(sqlite3* db) {
    sqlite3_extended_result_codes(db, 1);
    sqlite3_busy_timeout(db, busy_timeout_ms);
    sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(db, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
    sqlite3_db_config(db, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
    sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0, nullptr);
    // Nothing is written to a file before it was checked, not even when it is closed.
    sqlite3_db_config(db, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
}
}  // namespace

StoreResult<std::unique_ptr<Db>> Db::open(const std::string& file, Mode mode, const std::string& vfs) {
    std::unique_ptr<Db> db(new Db);
    db->place_.file = file;
    db->place_.directory = mode == Mode::memory ? std::string() : std::filesystem::path(file).parent_path().string();
    const int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE |
                      (mode == Mode::memory      ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_MEMORY
                       : mode == Mode::read_only ? SQLITE_OPEN_READONLY
                                                 : SQLITE_OPEN_READWRITE);
    const int rc =
        sqlite3_open_v2(mode == Mode::memory ? ":memory:" : file.c_str(), &db->handle_, flags, vfs.empty() ? nullptr : vfs.c_str());
    if (rc != SQLITE_OK) return fail(db->error(rc));
    harden(db->handle_);
    // Read-only connections use the same strict reading; foreign keys and the synchronous setting have no meaning for them.
    if (auto r = db->exec("PRAGMA foreign_keys=ON; PRAGMA temp_store=MEMORY; PRAGMA cell_size_check=ON; PRAGMA secure_delete=OFF"); !r) {
        return fail(r);
    }
    return db;
}

Db::~Db() {
    for (auto& [sql, statement] : statements_)
        sqlite3_finalize(statement);
    sqlite3_close(handle_);
}

void Db::between(int steps, void (*call)() noexcept) noexcept {
    const auto handler = [](void* what) -> int {
        reinterpret_cast<void (*)() noexcept>(what)();
        return 0;  // go on
    };
    sqlite3_progress_handler(handle_, steps, handler, reinterpret_cast<void*>(call));
}

StoreError Db::error(int rc, int system) {
    if (handle_ == nullptr) return sqlite_failure(rc, 0, sqlite3_errstr(rc), place_);
    // A constraint or a damaged page reports its extended code; rc alone may be the primary one.
    const int extended = sqlite3_extended_errcode(handle_);
    const int code = (extended & 0xFF) == (rc & 0xFF) ? extended : rc;
    const int primary = code & 0xFF;
    if (primary != SQLITE_IOERR && primary != SQLITE_CANTOPEN) {
        system = 0;
    } else if (system == 0 || system == ENOENT || system == EAGAIN ||
               system == EINTR) {  // those come from looking for files, after the failure
        system = sqlite3_system_errno(handle_);
    }
    const std::string message = sqlite3_errmsg(handle_);
    StorePlace place = place_;
    if (primary == SQLITE_FULL && place_.max_bytes != 0) {
        // SQLite reports "full" both for the disk and for max_page_count. The failed statement may be rolled back by now, so the count is
        // only close to the limit.
        place_.max_bytes = 0;  // an error of these two must not call them again
        const auto pages = integer("PRAGMA page_count");
        const auto most = integer("PRAGMA max_page_count");
        place_.max_bytes = place.max_bytes;
        place.at_size_limit = pages && most && *pages >= *most / 10 * 9;
    }
    return sqlite_failure(code, system, message, place);
}

StoreResult<> Db::exec(const char* sql) {
    errno = 0;
    const int rc = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
    if (rc != SQLITE_OK) return fail(error(rc, errno));
    return {};
}

StoreResult<std::int64_t> Db::integer(const char* sql) {
    Query q(*this, sql);
    const auto row = q.row();
    if (!row) return fail(row);
    return *row ? q.integer(0) : 0;
}

StoreResult<std::string> Db::text(const char* sql) {
    Query q(*this, sql);
    const auto row = q.row();
    if (!row) return fail(row);
    return *row ? q.text(0) : std::string();
}

StoreResult<> Db::begin() {
    if (in_transaction()) rollback();
    return Query(*this, "BEGIN IMMEDIATE").run();
}

StoreResult<> Db::commit() {
    auto r = Query(*this, "COMMIT").run();
    if (!r) rollback();
    return r;
}

void Db::rollback() noexcept {
    // After some errors (disk full, I/O) SQLite has already rolled back; a second ROLLBACK would only cause an error of its own.
    if (in_transaction()) sqlite3_exec(handle_, "ROLLBACK", nullptr, nullptr, nullptr);
}

sqlite3_stmt* Db::statement(const char* sql, int& rc) {
    const auto it = statements_.find(sql);
    if (it != statements_.end()) return it->second;
    sqlite3_stmt* s = nullptr;
    rc = sqlite3_prepare_v3(handle_, sql, -1, SQLITE_PREPARE_PERSISTENT, &s, nullptr);
    if (rc != SQLITE_OK) return nullptr;
    statements_.emplace(sql, s);
    return s;
}

// --- Query --------------------------------------------------------------------------------------------------------------

Query::Query(Db& db, const char* sql) : db_(db) { statement_ = db_.statement(sql, rc_); }

Query::~Query() {
    if (statement_ == nullptr) return;
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);  // releases copies of large texts
}

Query& Query::bind(std::int64_t v) {
    if (rc_ == SQLITE_OK) rc_ = sqlite3_bind_int64(statement_, next_++, v);
    return *this;
}

Query& Query::bind(std::string_view v) {
    // A view without data would bind NULL, which is not the empty text.
    if (rc_ == SQLITE_OK) {
        rc_ = sqlite3_bind_text64(statement_, next_++, v.data() == nullptr ? "" : v.data(), v.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    }
    return *this;
}

Query& Query::bind_null() {
    if (rc_ == SQLITE_OK) rc_ = sqlite3_bind_null(statement_, next_++);
    return *this;
}

Query& Query::bind_value(const Value& v) {
    if (const auto* b = std::get_if<bool>(&v)) return bind(std::string_view("b")).bind(std::int64_t{*b});
    if (const auto* i = std::get_if<std::int64_t>(&v)) return bind(std::string_view("i")).bind(*i);
    if (const auto* d = std::get_if<double>(&v)) {
        bind(std::string_view("f"));  // SQLite stores NaN as NULL; the type letter restores NaN
        if (rc_ == SQLITE_OK) rc_ = sqlite3_bind_double(statement_, next_++, *d);
        return *this;
    }
    if (const auto* s = std::get_if<std::string>(&v)) return bind(std::string_view("t")).bind(std::string_view(*s));
    return bind(std::string_view("u")).bind_null();
}

StoreError Query::error() { return db_.error(rc_, system_); }

StoreResult<bool> Query::row() {
    if (rc_ != SQLITE_OK) return fail(error());
    errno = 0;
    const int rc = sqlite3_step(statement_);
    if (rc == SQLITE_ROW) return true;
    if (rc == SQLITE_DONE) return false;
    system_ = errno;
    rc_ = rc;
    return fail(error());
}

StoreResult<> Query::run() {
    for (;;) {
        const auto r = row();
        if (!r) return fail(r);
        if (!*r) return {};
    }
}

std::string Query::text(int column) const {
    const auto* p = sqlite3_column_text(statement_, column);
    if (p == nullptr) return {};
    return {reinterpret_cast<const char*>(p), static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

StoreResult<Value> Query::value(int type_column) const {
    const std::string letter = text(type_column);
    const int at = type_column + 1;
    const int type = sqlite3_column_type(statement_, at);
    if (letter == "u" && type == SQLITE_NULL) return Value{};
    if (letter == "b" && type == SQLITE_INTEGER) return Value{integer(at) != 0};
    if (letter == "i" && type == SQLITE_INTEGER) return Value{integer(at)};
    if (letter == "f" && type == SQLITE_FLOAT) return Value{sqlite3_column_double(statement_, at)};
    if (letter == "f" && type == SQLITE_NULL) return Value{std::numeric_limits<double>::quiet_NaN()};
    if (letter == "t" && type == SQLITE_TEXT) return Value{text(at)};
    return fail(
        StoreError::Kind::corrupt,
        fmt::format("{} holds a value whose type '{}' and content do not belong together: it was altered by another program. Restore a "
                    "backup with `axisgate restore FILE`",
                    db_.file(), letter));
}

bool same_value(const Value& a, const Value& b) noexcept {
    if (a.index() != b.index()) return false;
    if (const auto* d = std::get_if<double>(&a)) {
        const double e = *std::get_if<double>(&b);
        if (*d != *d && e != e) return true;
        return std::bit_cast<std::uint64_t>(*d) == std::bit_cast<std::uint64_t>(e);
    }
    return a == b;
}

}  // namespace axisgate
