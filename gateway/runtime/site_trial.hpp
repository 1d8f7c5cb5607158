// Site trial: the stored mark of a site that is applied but not confirmed, and what a start does about it.
// In: the store, at start. Out: the site before the trial in force again, with an event.
// Never decides while the gateway runs: that is WarmStage's.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/store/store.hpp"

namespace axisgate {

/// Put on disk before a site is applied on trial, deleted when it is confirmed or rolled back.
[[nodiscard]] StoreResult<> mark_trial(Store& store, std::uint64_t roll_back_to, std::string_view who, std::int64_t confirm_by_unix_ns,
                                       std::int64_t now_unix_ns);
[[nodiscard]] StoreResult<> unmark_trial(Store& store);
/// At start: a trial that was not confirmed is rolled back (`roll_back` false: a site file takes its place, the mark goes). Empty, or a
/// fault.
[[nodiscard]] std::string end_trial(Store& store, bool roll_back);

}  // namespace axisgate
