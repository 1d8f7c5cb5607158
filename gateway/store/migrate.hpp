// Migrations: the numbered steps from an empty file to the structure that this program knows.
// In: SQL texts (schema/sql/NNNN_name.sql), a connection. Out: the file at the newest version, each step whole or not at all.
// Never goes back a version and never changes a file that is newer than the program or not axisgate's.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/store/files.hpp"
#include "gateway/store/sqlite.hpp"

namespace axisgate {

/// "AXGT" in the file's header (PRAGMA application_id): tells our files from other SQLite files.
inline constexpr std::int64_t application_id = 0x41584754;

struct Migration {
    int number = 0;        ///< 1, 2, 3, ... without gaps
    std::string name;      ///< file name, for messages
    std::string_view sql;  ///< statements; no transaction of their own. Outlives the store's opening
};

/// The migrations among the program's embedded files: those named schema/sql/NNNN_*.sql, in order of number.
/// Error `internal` if a number is missing or there twice.
[[nodiscard]] StoreResult<std::vector<Migration>> migrations_among(std::span<const Asset> assets);

/// PRAGMA user_version: how many migrations the file has seen.
[[nodiscard]] StoreResult<int> version_of(Db& db);
/// Good if the file is axisgate's and not newer than `newest`.
[[nodiscard]] StoreResult<> check_identity(Db& db, int newest);
/// Good if the file holds every table, column and index of `migrations` at the file's own version, and no trigger (there are none of ours:
/// one would change what is written behind our back). More tables or indexes than ours do no harm.
[[nodiscard]] StoreResult<> check_structure(Db& db, std::span<const Migration> migrations);
/// Good if SQLite finds the file sound. `thorough`: integrity_check (with the indexes' contents) and the references between tables;
/// else quick_check.
[[nodiscard]] StoreResult<> check_soundness(Db& db, bool thorough);
/// Runs the missing migrations, one transaction each; version and application id are set in the same transaction.
[[nodiscard]] StoreResult<> migrate(Db& db, std::span<const Migration> migrations);

}  // namespace axisgate
