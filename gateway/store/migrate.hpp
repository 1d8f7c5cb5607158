// The numbered steps (schema/sql/NNNN_name.sql) from an empty file to the structure that this program knows. Each step is applied
// completely or not at all. A version is never decreased, and a file that is newer than the program or not axisgate's is never changed.
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

/// "AXGT" in the file's header (PRAGMA application_id), which distinguishes axisgate's files from other SQLite files.
inline constexpr std::int64_t application_id = 0x41584754;

struct Migration {
    int number = 0;        ///< 1, 2, 3, ... without gaps
    std::string name;      ///< file name, for messages
    std::string_view sql;  ///< statements without a transaction of their own. Must outlive the opening of the store
};

/// The migrations among the program's embedded files: those named schema/sql/NNNN_*.sql, in order of number. Error `internal` if a number
/// is missing or duplicate.
[[nodiscard]] StoreResult<std::vector<Migration>> migrations_among(std::span<const Asset> assets);

/// PRAGMA user_version: the number of migrations applied to the file.
[[nodiscard]] StoreResult<int> version_of(Db& db);
/// Good if the file is axisgate's and not newer than `newest`.
[[nodiscard]] StoreResult<> check_identity(Db& db, int newest);
/// Good if the file has every table, column and index of `migrations` at its own version, and no trigger (axisgate has none, and a foreign
/// one could change written data). Additional tables and indexes are accepted.
[[nodiscard]] StoreResult<> check_structure(Db& db, std::span<const Migration> migrations);
/// Good if SQLite finds no damage in the file. `thorough`: integrity_check (with the indexes' contents) and the references between tables;
/// otherwise quick_check.
[[nodiscard]] StoreResult<> check_soundness(Db& db, bool thorough);
/// Runs the missing migrations, one transaction each; version and application id are set in the same transaction.
[[nodiscard]] StoreResult<> migrate(Db& db, std::span<const Migration> migrations);

}  // namespace axisgate
