// The files of this host that belong to a backup, and the making of the backup. It is read back and checked; no unfinished file is left,
// and a backup without a file that the configuration names does not count as good.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gateway/runtime/backup_file.hpp"
#include "gateway/runtime/config.hpp"

namespace axisgate {

struct BackupPlan {
    std::string data_dir;
    std::string config_file;        ///< empty: the program was started without one
    std::string tls_cert, tls_key;  ///< empty: not configured
    std::string dds_dir;            ///< of [dds] security; empty: off
};
[[nodiscard]] BackupPlan backup_plan(const Config& config, const std::string& config_file);
/// The path of a member on this host; empty if the host has no place for it. The database belongs to the store.
[[nodiscard]] std::optional<std::string> place_of(std::string_view member, const BackupPlan& plan);

struct BackupOrder {
    std::string passphrase;  ///< empty: not sealed
    bool keys = true;        ///< include private keys
};
/// Makes `target` (mode 0600, replacing an older one). Works while the gateway runs. A crash leaves files `target.*.part`.
[[nodiscard]] BackupResult<BackupContents> make_backup(const BackupPlan& plan, const BackupOrder& order, const std::string& target);

}  // namespace axisgate
