// Site trial: the stored mark of a site that is applied but not confirmed, and what a start does about it; and a backup laid down.
// In: the store, at start. Out: the site before the trial in force again, with an event; the backup in the database's place.
// Never decides while the gateway runs: that is WarmGateway's.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/store/store.hpp"

namespace axisgate {

/// Put on disk before a site is applied on trial, deleted when it is confirmed or rolled back.
[[nodiscard]] StoreResult<> mark_trial(Store& store, std::uint64_t roll_back_to, std::string_view who, std::int64_t confirm_by_unix_ns,
                                       std::int64_t now_unix_ns);
[[nodiscard]] StoreResult<> unmark_trial(Store& store);
/// What a site means for the names that the store knows.
[[nodiscard]] SiteChange names_of(const Site& site);
/// At start: a trial that was not confirmed is rolled back (`roll_back` false: a site file takes its place, the mark goes). Empty, or a
/// fault.
[[nodiscard]] std::string end_trial(Store& store, bool roll_back);

/// Where a backup waits for the next start.
[[nodiscard]] std::string laid_down_backup(const std::string& directory);
/// At start, before the database is opened. Empty, or a fault; the file is then kept aside, so that the next start goes on without it.
[[nodiscard]] std::string take_laid_down_backup(const StoreOptions& options);

}  // namespace axisgate
