// A backup as one tar: a contents list, the database, the files of the host, and their checksums. A member is passed on only after the last
// checksum was correct, and only under a name of the list below.
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

/// The version of the form. A program refuses newer ones and reads all older ones.
inline constexpr int backup_form = 1;
inline constexpr std::string_view database_member = "axisgate.db";
inline constexpr std::string_view configuration_member = "axisgate.toml";
/// The possible members besides contents and checksums; the first is always present, each of the others has at most 1 MiB. http-*: the
/// certificate that the gateway has made; tls-*: the one that the configuration names; dds/: the folder of [dds] security.
inline constexpr std::array<std::string_view, 12> backup_members = {
    database_member,       configuration_member,     "http-cert.pem", "http-key.pem", "tls-cert.pem",       "tls-key.pem",
    "dds/identity-ca.pem", "dds/permissions-ca.pem", "dds/cert.pem",  "dds/key.pem",  "dds/governance.p7s", "dds/permissions.p7s"};

struct BackupMember {
    std::string name;  ///< one of backup_members
    std::string path;  ///< path of its file
};
struct BackupContents {
    std::string program;  ///< version of the program that made it
    std::string host;     ///< the host on which it was made
    std::int64_t made_at_unix_s = 0;
    std::vector<std::string> members;
    std::vector<std::pair<std::string, std::string>> left_out;  ///< members that were left out, with the reasons
};

/// `contents.members` is filled from `members`. A file whose size changes meanwhile is a fault.
[[nodiscard]] BackupResult<> write_backup(ByteSink& to, BackupContents contents, const std::vector<BackupMember>& members);
/// Reads the whole backup and checks everything. `folder` is made, and must not exist; the members are put into it by their names. Empty: a
/// check only. After a fault the content of the folder must not be used.
[[nodiscard]] BackupResult<BackupContents> read_backup(ByteSource& from, const std::string& folder);

enum class BackupForm : std::uint8_t { none, database, archive, sealed };
/// Determines the form from the first 512 bytes. `database`: a plain database, as written by older versions of the program.
[[nodiscard]] BackupForm backup_form_of(std::string_view head) noexcept;
[[nodiscard]] BackupResult<BackupForm> backup_form_of_file(const std::string& path);
/// Opens either form of archive and passes its stream to read_backup.
[[nodiscard]] BackupResult<BackupContents> open_backup(const std::string& path, const std::string& passphrase, const std::string& folder);
/// Writes the decrypted content of the sealed bytes to the file `plain`, each chunk authenticated; after a fault the file must not be used.
[[nodiscard]] BackupResult<> unseal_backup(std::string_view bytes, const std::string& passphrase, const std::string& plain);

}  // namespace axisgate
