// The whole gateway as one file: made for a download, and stored for the next start. Results come by callbacks on the service thread. The
// database in use is never replaced.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "gateway/core/command.hpp"

namespace axisgate {

/// The outcome of a backup that was requested or sent. Faults of a sent backup name no path.
struct BackupOutcome {
    std::string fault;     ///< empty: done
    bool no_room = false;  ///< the request may be good, but this machine could not store or make the backup
    std::string note;      ///< the parts that are not restored; empty: none
};

/// A backup that is stored for the next start.
struct WaitingBackup {
    std::int64_t at_unix_ns = 0;
    std::string who;  ///< empty: unknown
    std::uint64_t bytes = 0;
    int version = 0;                  ///< of the database's structure; 0: unknown
    std::uint64_t site_revision = 0;  ///< the revision in force in it; 0: none, or unknown
};

class BackupPort {
public:
    virtual ~BackupPort() = default;
    /// Makes a complete, checked copy, sealed if there is a passphrase, and then with private keys; or an empty one with the reason.
    virtual void backup(std::string passphrase, std::function<void(std::optional<std::string> bytes, BackupOutcome)> then) = 0;
    /// Checks a backup and stores it for the next start. The passphrase applies only to a sealed one.
    virtual void restore(std::string bytes, std::string passphrase, Origin origin, std::function<void(BackupOutcome)> then) = 0;
    virtual void waiting_backup(std::function<void(std::optional<WaitingBackup>)> then) = 0;
    /// Removes the stored backup; returns empty, or the reason why not; "none" if there is none.
    virtual void cancel_restore(Origin origin, std::function<void(std::string fault)> then) = 0;
};

}  // namespace axisgate
