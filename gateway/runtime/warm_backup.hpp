// The backup port: copies of the database made, checked and stored on the storage thread. A copy of more than 64 MiB is not sent; `axisgate
// backup` makes it. Answers never contain a path.
#pragma once

#include "gateway/runtime/backup_plan.hpp"
#include "gateway/runtime/warm_events.hpp"
#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/backup.hpp"

namespace axisgate {

class WarmBackup final : public BackupPort {
public:
    WarmBackup(const WarmThreads& threads, WarmEvents& events) : threads_(threads), events_(events) {}
    /// The files that belong to a backup; must be set before the first request.
    void use(BackupPlan plan) { plan_ = std::move(plan); }
    void backup(std::string passphrase, std::function<void(std::optional<std::string> bytes, BackupOutcome)> then) override;
    void restore(std::string bytes, std::string passphrase, Origin origin, std::function<void(BackupOutcome)> then) override;
    void waiting_backup(std::function<void(std::optional<WaitingBackup>)> then) override;
    void cancel_restore(Origin origin, std::function<void(std::string fault)> then) override;

private:
    const WarmThreads& threads_;
    WarmEvents& events_;
    BackupPlan plan_;
};

}  // namespace axisgate
