// The stored mark of a site that is applied but not confirmed, and its handling at the start: the site before the trial is restored, with
// an event. While the gateway runs, WarmStage decides.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/store/store.hpp"

namespace axisgate {

/// Stored before a site is applied on trial, deleted when it is confirmed or rolled back.
[[nodiscard]] StoreResult<> mark_trial(Store& store, std::uint64_t roll_back_to, std::string_view who, std::int64_t confirm_by_unix_ns,
                                       std::int64_t now_unix_ns);
[[nodiscard]] StoreResult<> unmark_trial(Store& store);
/// At the start: a trial that was not confirmed is rolled back (`roll_back` false: a site file replaces it, and only the mark is deleted).
/// Empty, or a fault.
[[nodiscard]] std::string end_trial(Store& store, bool roll_back);

}  // namespace axisgate
