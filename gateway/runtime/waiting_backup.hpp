// Waiting backup: a backup that was checked and laid down in the data directory, to take the database's place at the next start.
// In: the file's bytes, who sent it. Out: what waits; the backup in the database's place; faults in words.
// Never lays down what this program would not open, and never names a path of the machine to who sent the file.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gateway/services/ports/backup.hpp"
#include "gateway/store/records.hpp"

namespace axisgate {

/// Checks the bytes (a backup file of either form, or a plain database) and lays them down in `options.directory`, in the place of what
/// waited there.
[[nodiscard]] BackupOutcome lay_down_backup(const std::string& bytes, const std::string& passphrase, const std::string& who,
                                            std::int64_t at_unix_ns, const StoreOptions& options);
[[nodiscard]] std::optional<WaitingBackup> waiting_backup(const std::string& directory);
/// Empty, or a fault; "none" if nothing waits.
[[nodiscard]] std::string cancel_waiting_backup(const std::string& directory);
/// At start, before the database is opened: the database, and the certificate of the gateway's own making. Empty, or a fault; the file is
/// then kept aside, so that the next start goes on without it, unless another gateway serves the directory.
[[nodiscard]] std::string take_waiting_backup(const StoreOptions& options);

/// Name under which a backup is made for a download, in the data directory; more may follow it.
inline constexpr std::string_view download_name = "backup-for-download.tmp";
/// At start, with the directory locked: what a killed gateway left of backups that it was making, taking or checking. What waits stays.
void remove_backup_leftovers(const std::string& directory);

}  // namespace axisgate
