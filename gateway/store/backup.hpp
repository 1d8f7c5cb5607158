// Backup and restore of the whole database as one file. A file replaces another one only after it was checked, and a database that is being
// served is never opened for writing.
#pragma once

#include <string>

#include "gateway/store/error.hpp"
#include "gateway/store/records.hpp"

namespace axisgate {

/// Writes a compact copy of the database, as of one instant, to `target` (replacing an older backup of that name): to a temporary file
/// beside it, checked, made durable, then renamed. Works while the gateway runs, from any thread or process, without stopping writers. A
/// crash during the backup leaves `target` as it was, and a file `target.*.part`, which may be removed.
/// Errors: not_found (no database), invalid (target is part of the data directory's own files), disk_full, corrupt (the source), ...
[[nodiscard]] StoreResult<> backup_database(const std::string& directory, const std::string& target);

/// Checks whether a file of that name may be made beside the data directory's own; `invalid` if not.
[[nodiscard]] StoreResult<> check_backup_target(const std::string& directory, const std::string& target);

struct RestoreReport {
    std::string kept;                          ///< path of the replaced database; empty if there was none
    int version = 0;                           ///< of the restored file; the next start upgrades it if it is older than the program
    std::uint64_t site_revision = 0;           ///< in force in it; 0: none
    std::uint64_t replaced_site_revision = 0;  ///< in force in the replaced one; 0: none, or it could not be read
};
/// Replaces the database in `options.directory` (which may be empty or missing) by the backup `source`. The gateway must not run. The file
/// is copied, then checked (complete, axisgate's, not newer than the program, structure); the replaced database is kept as
/// axisgate.db.replaced-N. A crash leaves the old database or the new one: a replacement that has begun is finished at the next start.
[[nodiscard]] StoreResult<RestoreReport> restore_database(const std::string& source, const StoreOptions& options);

/// Finishes a restore that was interrupted after its check, and removes unfinished files. The caller holds the lock. Returns the path of
/// the replaced database; empty if nothing was replaced.
[[nodiscard]] StoreResult<std::string> finish_restore(const StoreFiles& files);

}  // namespace axisgate
