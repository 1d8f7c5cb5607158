// A note that a restore leaves beside the database, because the events after it come from the backup: the next start makes an event of it
// and deletes it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/core/event.hpp"
#include "gateway/store/backup.hpp"

namespace axisgate {

/// The warning for every kind of restore.
inline constexpr auto restore_warning =
    "users, tokens and certificates are those of the backup: who was removed, or whose token was taken back, since it was made is let in "
    "again; look at the users and tokens";

struct RestoreNote {
    std::string who;  ///< "anna 192.0.2.7", or the user of this machine
    std::int64_t at_unix_ns = 0;
    std::uint64_t replaced_revision = 0;  ///< of the site that was in force; 0: none
    std::uint64_t restored_revision = 0;  ///< of the site of the backup
};
/// Writes the note with the owner of the directory. Empty, or the reason why not.
[[nodiscard]] std::string leave_restore_note(const std::string& directory, const RestoreNote& note);
/// The event of an existing note, which is removed.
[[nodiscard]] std::optional<Event> take_restore_note(const std::string& directory);

}  // namespace axisgate
