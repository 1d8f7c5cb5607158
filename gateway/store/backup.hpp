// Backup and restore of the whole database as one file.
// In: a data directory, a path. Out: a file that was checked, or the reason why not.
// Never replaces anything by something that was not found good first; never opens a database that is being served for writing.
#pragma once

#include <string>

#include "gateway/store/error.hpp"
#include "gateway/store/records.hpp"

namespace axisgate {

/// Writes a compact copy of the database, as of one instant, to `target` (replacing an older backup of that name): to a temporary file
/// beside it, checked, made durable, then renamed. Works while the gateway runs, from any thread or process; writers go on.
/// A crash half-way leaves `target` as it was and a file `target.*.part`, which may be removed.
/// Errors: not_found (no database), invalid (target is part of the data directory's own files), disk_full, corrupt (the source), ...
[[nodiscard]] StoreResult<> backup_database(const std::string& directory, const std::string& target);

/// Whether a file of that name may be made beside the data directory's own: `invalid` if not.
[[nodiscard]] StoreResult<> check_backup_target(const std::string& directory, const std::string& target);

struct RestoreReport {
    std::string kept;                          ///< where the replaced database now is; empty if there was none
    int version = 0;                           ///< of the restored file; the next start upgrades it if it is older than the program
    std::uint64_t site_revision = 0;           ///< in force in it; 0: none
    std::uint64_t replaced_site_revision = 0;  ///< in force in the replaced one; 0: none, or it could not be read
};
/// Puts the backup `source` in the place of the database in `options.directory` (which may be empty or missing). The gateway must not
/// run. The file is copied, then checked (whole, axisgate's, not newer than the program, structure); the replaced database is kept as
/// axisgate.db.replaced-N. A crash leaves the old database or the new one: what was begun is finished at the next start.
[[nodiscard]] StoreResult<RestoreReport> restore_database(const std::string& source, const StoreOptions& options);

/// Finishes a restore that was interrupted after its check, and clears what others left half done. The caller holds the lock.
/// The path where the replaced database is kept; empty if nothing was replaced.
[[nodiscard]] StoreResult<std::string> finish_restore(const StoreFiles& files);

}  // namespace axisgate
