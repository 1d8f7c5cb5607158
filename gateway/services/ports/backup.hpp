// Backup port: the database as one file: taken out, and laid down for the next start.
// In: bytes of a backup. Out: bytes, or why not, by callbacks on the service thread.
// Never replaces the database that is in use.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "gateway/core/command.hpp"

namespace axisgate {

/// Why a backup was not laid down; `text` empty: it was. Faults name no path.
struct RestoreFault {
    std::string text;
    bool no_room = false;  ///< the backup may be good: this machine could not keep it
};

/// A backup that was laid down and waits for the next start.
struct WaitingBackup {
    std::int64_t at_unix_ns = 0;
    std::string who;  ///< empty: not known
    std::uint64_t bytes = 0;
    int version = 0;                  ///< of the database's structure; 0: not known
    std::uint64_t site_revision = 0;  ///< in force in it; 0: none, or not known
};

class BackupPort {
public:
    virtual ~BackupPort() = default;
    /// A whole, checked copy of the database, or nothing and why.
    virtual void backup(std::function<void(std::optional<std::string> bytes, std::string fault)> then) = 0;
    /// Checks a backup and lays it down to be taken at the next start.
    virtual void restore(std::string bytes, Origin origin, std::function<void(RestoreFault)> then) = 0;
    virtual void waiting_backup(std::function<void(std::optional<WaitingBackup>)> then) = 0;
    /// Takes it away again: empty, or why not; nothing waits: "none".
    virtual void cancel_restore(Origin origin, std::function<void(std::string fault)> then) = 0;
};

}  // namespace axisgate
