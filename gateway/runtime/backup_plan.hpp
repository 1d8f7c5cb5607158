// Backup plan: which files of this host belong into a backup, where each is, and the backup itself.
// In: the configuration. Out: a file that was read back and found good, or why not. Never leaves a half-made file behind, and never says
// that a backup is good which lacks a file that the configuration names.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gateway/runtime/backup_file.hpp"
#include "gateway/runtime/config.hpp"

namespace axisgate {

struct BackupPlan {
    std::string data_dir;
    std::string config_file;        ///< empty: it was started without one
    std::string tls_cert, tls_key;  ///< empty: none of its own
    std::string dds_dir;            ///< of [dds] security; empty: off
};
[[nodiscard]] BackupPlan backup_plan(const Config& config, const std::string& config_file);
/// The path of a member on the host of this plan; nothing: this host has no place for it. The database's is the store's alone.
[[nodiscard]] std::optional<std::string> place_of(std::string_view member, const BackupPlan& plan);

struct BackupOrder {
    std::string passphrase;  ///< empty: not sealed
    bool keys = true;        ///< private keys too
};
/// Makes `target` (mode 0600, replacing an older one). Works while the gateway runs. A crash leaves files `target.*.part`.
[[nodiscard]] BackupResult<BackupContents> make_backup(const BackupPlan& plan, const BackupOrder& order, const std::string& target);

}  // namespace axisgate
