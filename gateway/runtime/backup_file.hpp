// Backup file: everything that makes a gateway, as one tar: a contents list, the database, the files of the host, and their checksums last.
// In: members and where they come from; a stream. Out: a stream; a folder with the members, each of which was found as it was put in.
// Never hands on a member before the last checksum was right, and never a name that is not on the list below.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/runtime/backup_stream.hpp"

namespace axisgate {

/// Of the form. A program refuses a newer one, and takes every older one.
inline constexpr int backup_form = 1;
inline constexpr std::string_view database_member = "axisgate.db";
inline constexpr std::string_view configuration_member = "axisgate.toml";
/// All that there can be beside contents and checksums; the first is always there, each but that at most 1 MiB.
/// http-*: the certificate of the gateway's own making; tls-*: the one that the configuration names; dds/: the folder of [dds] security.
inline constexpr std::array<std::string_view, 12> backup_members = {
    database_member,       configuration_member,     "http-cert.pem", "http-key.pem", "tls-cert.pem",       "tls-key.pem",
    "dds/identity-ca.pem", "dds/permissions-ca.pem", "dds/cert.pem",  "dds/key.pem",  "dds/governance.p7s", "dds/permissions.p7s"};

struct BackupMember {
    std::string name;  ///< one of backup_members
    std::string path;  ///< of the file that it is
};
struct BackupContents {
    std::string program;  ///< version of the axisgate that made it
    std::string host;     ///< where
    std::int64_t made_at_unix_s = 0;
    std::vector<std::string> members;
    std::vector<std::pair<std::string, std::string>> left_out;  ///< what, and why
};

/// `contents.members` is filled from `members`. A file that grows or shrinks meanwhile is a fault.
[[nodiscard]] BackupResult<> write_backup(ByteSink& to, BackupContents contents, const std::vector<BackupMember>& members);
/// Reads it to its end and checks everything. `folder`: is made, and must not be there; the members are in it, by their names. Empty:
/// nothing is kept, which is a check alone. On a fault what was put into the folder is worth nothing.
[[nodiscard]] BackupResult<BackupContents> read_backup(ByteSource& from, const std::string& folder);

enum class BackupForm : std::uint8_t { none, database, archive, sealed };
/// By the first 512 bytes. `database`: the plain database, as programs before this form made it.
[[nodiscard]] BackupForm backup_form_of(std::string_view head) noexcept;
[[nodiscard]] BackupResult<BackupForm> backup_form_of_file(const std::string& path);
/// Opens either form of archive and hands its stream to read_backup.
[[nodiscard]] BackupResult<BackupContents> open_backup(const std::string& path, const std::string& passphrase, const std::string& folder);
/// Writes to the file `plain` what the sealed bytes hold, each chunk of it authenticated; on a fault the file is worth nothing.
[[nodiscard]] BackupResult<> unseal_backup(std::string_view bytes, const std::string& passphrase, const std::string& plain);

}  // namespace axisgate
