// SQLite's C interface with owners, results as values, and statements that are prepared once. SQL is never built from data, nothing throws,
// and a read stays open only as long as its Query.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "gateway/core/value.hpp"
#include "gateway/store/error.hpp"

namespace axisgate {

/// One connection. Used by one thread at a time.
class Db {
public:
    enum class Mode : std::uint8_t { read_write, read_only, memory };
    /// Opens an existing file; it is never created here. `vfs` is SQLite's name of the file layer; empty: the default.
    [[nodiscard]] static StoreResult<std::unique_ptr<Db>> open(const std::string& file, Mode mode, const std::string& vfs = {});
    ~Db();
    Db(const Db&) = delete;
    Db& operator=(const Db&) = delete;

    /// Runs SQL of several statements without results.
    [[nodiscard]] StoreResult<> exec(const char* sql);
    /// First column of the first row as a whole number; 0 if there is no row.
    [[nodiscard]] StoreResult<std::int64_t> integer(const char* sql);
    /// First column of the first row as text.
    [[nodiscard]] StoreResult<std::string> text(const char* sql);
    /// Runs `body` between BEGIN IMMEDIATE and COMMIT; an error of any of them undoes everything. If it returns without an error, the data
    /// are on the disk.
    template <class Body>
    [[nodiscard]] auto transaction(Body&& body) -> decltype(body()) {
        if (auto begun = begin(); !begun) return fail(begun);
        auto result = body();
        if (!result) {
            rollback();
            return result;
        }
        if (auto committed = commit(); !committed) return fail(committed);
        return result;
    }

    [[nodiscard]] std::int64_t last_id() const noexcept { return sqlite3_last_insert_rowid(handle_); }
    /// Rows changed by the last INSERT, UPDATE or DELETE.
    [[nodiscard]] int changes() const noexcept { return sqlite3_changes(handle_); }
    [[nodiscard]] bool in_transaction() const noexcept { return sqlite3_get_autocommit(handle_) == 0; }
    [[nodiscard]] sqlite3* handle() noexcept { return handle_; }
    [[nodiscard]] const std::string& file() const noexcept { return place_.file; }
    /// Calls `call` every `steps` steps of a statement from now on.
    void between(int steps, void (*call)() noexcept) noexcept;
    /// For messages if SQLITE_FULL comes from PRAGMA max_page_count.
    void set_max_bytes(std::uint64_t bytes) noexcept { place_.max_bytes = bytes; }
    /// The error of the last call. `system` is errno right after it; SQLite forgets that of a failed COMMIT.
    [[nodiscard]] StoreError error(int rc, int system = 0);

private:
    friend class Query;
    Db() = default;
    [[nodiscard]] StoreResult<> begin();
    [[nodiscard]] StoreResult<> commit();
    void rollback() noexcept;
    /// The statement of this SQL, prepared at its first use. `sql` is a string literal or otherwise outlives the connection.
    [[nodiscard]] sqlite3_stmt* statement(const char* sql, int& rc);

    sqlite3* handle_ = nullptr;
    StorePlace place_;
    std::unordered_map<const char*, sqlite3_stmt*> statements_;
};

/// One use of a prepared statement. Bind from left to right, then read rows or run. The destructor resets the statement. A statement is not
/// used twice at once: finish one Query before another with the same SQL begins.
class Query {
public:
    Query(Db& db, const char* sql);
    ~Query();
    Query(const Query&) = delete;
    Query& operator=(const Query&) = delete;

    Query& bind(std::int64_t v);
    Query& bind(std::string_view v);
    /// Two columns: type letter and value (described in schema/sql/0001_base.sql).
    Query& bind_value(const Value& v);
    Query& bind_null();

    /// True if there is a row to read; false if there are no more.
    [[nodiscard]] StoreResult<bool> row();
    /// Runs to the end and ignores rows.
    [[nodiscard]] StoreResult<> run();

    [[nodiscard]] bool null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }
    [[nodiscard]] std::int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
    [[nodiscard]] std::string text(int column) const;
    /// A value from its two columns. An error if they do not fit: then the file was altered by another program.
    [[nodiscard]] StoreResult<Value> value(int type_column) const;

private:
    [[nodiscard]] StoreError error();

    Db& db_;
    sqlite3_stmt* statement_ = nullptr;
    int rc_ = SQLITE_OK;
    int system_ = 0;
    int next_ = 1;
};

/// Equal in kind and in every bit: NaN equals NaN, 0.0 differs from -0.0, 1 differs from 1.0.
[[nodiscard]] bool same_value(const Value& a, const Value& b) noexcept;

}  // namespace axisgate
