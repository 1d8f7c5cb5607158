// Jobs of the storage thread are answered on the service thread; a stored backup causes an event. The file of a download is deleted before
// the answer is sent.
#include "gateway/runtime/warm_backup.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/runtime/waiting_backup.hpp"

namespace axisgate {
namespace {
constexpr std::size_t most_backup_bytes = 64ull << 20;  // a larger one is made with `axisgate backup`
}  // namespace

void WarmBackup::backup(std::string passphrase, std::function<void(std::optional<std::string> bytes, BackupOutcome)> then) {
    threads_.on_cold([this, plan = plan_, passphrase = std::move(passphrase), then = std::move(then)](Store& store) {
        const std::string file = fmt::format("{}/{}", store.directory(), download_name);
        BackupOutcome outcome;
        std::optional<std::string> bytes;
        if (const auto made = make_backup(plan, {passphrase, !passphrase.empty()}, file); !made) {
            outcome = {made.error().text, made.error().kind != BackupFault::Kind::passphrase_unfit, {}};
        } else {
            bytes = read_file(file, outcome.fault, most_backup_bytes);
            outcome.no_room = !bytes;
        }
        std::error_code ec;
        std::filesystem::remove(file, ec);
        threads_.answer(
            [then, bytes = std::move(bytes), outcome = std::move(outcome)]() mutable { then(std::move(bytes), std::move(outcome)); });
    });
}

void WarmBackup::restore(std::string bytes, std::string passphrase, Origin origin, std::function<void(BackupOutcome)> then) {
    threads_.on_cold([this, bytes = std::move(bytes), passphrase = std::move(passphrase), origin = std::move(origin),
                      then = std::move(then)](Store& store) {
        const auto outcome = lay_down_backup(bytes, passphrase, origin.who ? *origin.who : origin.text(), unix_now_ns(), store.options());
        threads_.answer([this, origin, then, outcome] {
            if (outcome.fault.empty())
                events_.note("site", "a backup was laid down: it takes the place of the database at the next start", origin,
                             Severity::warning);
            then(outcome);
        });
    });
}

void WarmBackup::waiting_backup(std::function<void(std::optional<WaitingBackup>)> then) {
    threads_.on_cold([this, then = std::move(then)](Store& store) {
        threads_.answer([then, waits = axisgate::waiting_backup(store.directory())] { then(waits); });
    });
}

void WarmBackup::cancel_restore(Origin origin, std::function<void(std::string fault)> then) {
    threads_.on_cold([this, origin = std::move(origin), then = std::move(then)](Store& store) {
        const std::string fault = cancel_waiting_backup(store.directory());
        threads_.answer([this, origin, then, fault] {
            if (fault.empty())
                events_.note("site",
                             "the backup that was laid down was taken away again: the next start goes on with the database as it is",
                             origin, Severity::warning);
            then(fault);
        });
    });
}

}  // namespace axisgate
