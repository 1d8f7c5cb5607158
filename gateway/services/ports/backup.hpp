// Backup port: the whole gateway as one file: taken out, and laid down for the next start.
// In: bytes of a backup, a passphrase. Out: bytes, or why not, by callbacks on the service thread.
// Never replaces the database that is in use.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "gateway/core/command.hpp"

namespace axisgate {

/// What came of a backup that was asked for or sent. Faults of what was sent name no path.
struct BackupOutcome {
    std::string fault;     ///< empty: done
    bool no_room = false;  ///< what was sent or asked for may be good: this machine could not keep or make it
    std::string note;      ///< what of it is not taken; empty: nothing
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
    /// A whole, checked copy, sealed if there is a passphrase, and then with private keys; or nothing and why.
    virtual void backup(std::string passphrase, std::function<void(std::optional<std::string> bytes, BackupOutcome)> then) = 0;
    /// Checks a backup and lays it down to be taken at the next start. The passphrase counts for a sealed one alone.
    virtual void restore(std::string bytes, std::string passphrase, Origin origin, std::function<void(BackupOutcome)> then) = 0;
    virtual void waiting_backup(std::function<void(std::optional<WaitingBackup>)> then) = 0;
    /// Takes it away again: empty, or why not; nothing waits: "none".
    virtual void cancel_restore(Origin origin, std::function<void(std::string fault)> then) = 0;
};

}  // namespace axisgate
