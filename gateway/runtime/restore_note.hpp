// Restore note: what a restore leaves beside the database, so that the next start tells of it among the events, which came from the backup.
// In: who restored what, and when. Out: one event. Never kept longer than until it is told.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/core/event.hpp"
#include "gateway/store/backup.hpp"

namespace axisgate {

/// Said wherever somebody restores.
inline constexpr auto restore_warning =
    "users, tokens and certificates are those of the backup: who was removed, or whose token was taken back, since it was made is let in "
    "again; look at the users and tokens";

struct RestoreNote {
    std::string who;  ///< "anna 192.0.2.7", or the user of this machine
    std::int64_t at_unix_ns = 0;
    std::uint64_t replaced_revision = 0;  ///< of the site that was in force; 0: there was none
    std::uint64_t restored_revision = 0;  ///< of the site of the backup
};
/// Writes it, owned as the directory is. Empty, or why not.
[[nodiscard]] std::string leave_restore_note(const std::string& directory, const RestoreNote& note);
/// The event of the note that is there; it is taken away.
[[nodiscard]] std::optional<Event> take_restore_note(const std::string& directory);

}  // namespace axisgate
