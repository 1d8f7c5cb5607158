// A checked backup in the data directory that replaces the database at the next start. A backup that this program cannot open is refused,
// and the sender of a file never sees a path of this machine.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gateway/services/ports/backup.hpp"
#include "gateway/store/records.hpp"

namespace axisgate {

/// Checks the bytes (a backup file of either form, or a plain database) and stores them in `options.directory`, replacing an earlier one.
[[nodiscard]] BackupOutcome lay_down_backup(const std::string& bytes, const std::string& passphrase, const std::string& who,
                                            std::int64_t at_unix_ns, const StoreOptions& options);
[[nodiscard]] std::optional<WaitingBackup> waiting_backup(const std::string& directory);
/// Empty, or a fault; "none" if there is no stored backup.
[[nodiscard]] std::string cancel_waiting_backup(const std::string& directory);
/// At the start, before the database is opened: restores the database, and the certificate that the gateway has made. Empty, or a fault;
/// the file is then renamed, so that the next start continues without it, unless another gateway serves the directory.
[[nodiscard]] std::string take_waiting_backup(const StoreOptions& options);

/// Name of a backup that is made for a download, in the data directory; more may follow it.
inline constexpr std::string_view download_name = "backup-for-download.tmp";
/// At the start, with the directory locked: removes files of backups that a killed gateway was making, restoring or checking. A stored
/// backup stays.
void remove_backup_leftovers(const std::string& directory);

}  // namespace axisgate
