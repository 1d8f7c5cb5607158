// What the store takes and gives: plain values, and the bounds of each.
// In: built by the runtime from results, samples, notices and the site. Out: the same, read back.
// Never holds ids of the running process (AxisId, DriveId): names alone outlive it. Times are nanoseconds since 1970 (UTC).
//
// Event, EventQuery, StoredParameter, SiteRevision and the snapshots are gateway/core/records.hpp's; what is added to them here is added by
// derivation, so that a vector of ours can be handed on as a vector of theirs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/core/records.hpp"
#include "gateway/core/value.hpp"
#include "gateway/store/migrate.hpp"

namespace axisgate {

/// Bounds of the database. What lies beyond a bound of rows goes, oldest first; what is too long or too many is refused (`invalid`),
/// except that texts of events are cut: an event must not be lost for its length.
struct StoreLimits {
    std::uint64_t site_revisions = 1000;
    std::uint64_t site_bytes = 256ull << 20;   ///< their documents together; the one in force stays whatever its length
    std::uint64_t removed_axes = 1000;         ///< with all that is stored for them
    std::uint64_t parameter_writes = 100'000;  ///< rows of the history, all axes together
    std::uint64_t events = 200'000;
    std::uint64_t piece = 256;                      ///< rows deleted beyond those added, per transaction, when a table is over its bound
    std::uint64_t max_bytes = 2ull << 30;           ///< size of the database file; 0: only the disk bounds it
    std::int64_t seen_refresh_ns = 60'000'000'000;  ///< an unchanged value last seen is not written again before this time (spares flash)
};
inline constexpr std::size_t max_name_bytes = 256;         ///< axis, drive, parameter, snapshot and document names
inline constexpr std::size_t max_value_bytes = 1u << 20;   ///< one text value
inline constexpr std::size_t max_event_text_bytes = 8192;  ///< longer ones are cut, marked with " [...]"
inline constexpr std::size_t max_comment_bytes = 65'536;
inline constexpr std::size_t max_site_bytes = 16u << 20;
inline constexpr std::size_t max_document_bytes = 1u << 20;
inline constexpr std::size_t max_documents = 10'000;  ///< per kind
inline constexpr std::size_t max_description_bytes = 1u << 20;
inline constexpr std::size_t max_descriptions = 200;
inline constexpr std::size_t max_batch_rows = 10'000;       ///< writes, events and seen values of one batch, each
inline constexpr std::size_t max_snapshot_values = 65'536;  ///< also of one twin's memory
inline constexpr std::size_t max_snapshots = 1'000;         ///< per axis
inline constexpr std::uint64_t max_event_id = 1ull << 53;   ///< exact as a JSON number
inline constexpr int steps_between = 100;                   ///< steps of SQLite's virtual machine; a row that is written takes some 40
inline constexpr std::size_t max_answer_rows = 10'000;      ///< of history and events: more are read in pages

struct StoreOptions {
    std::string directory;
    std::vector<Migration> migrations;  ///< see migrations_among; their SQL text outlives the call
    StoreLimits limits;
    std::string vfs;  ///< SQLite file layer by name; empty: the usual one
    /// Called every `steps_between` steps of every statement (some 10 us), also of those that open, check and upgrade the file; none:
    /// nullptr.
    void (*between)() noexcept = nullptr;
};

/// A write that a drive acknowledged.
struct ParameterWrite {
    std::string axis;
    std::string parameter;  ///< catalogue id, with its element where it is an array: "AC", "N[17]"
    Value value;
    Value previous;  ///< what it was before; unknown if nobody knew
    Door door = Door::internal;
    std::string who;  ///< "192.0.2.7:51123", "token commissioning"
    std::int64_t at_unix_ns = 0;
    std::string storage;  ///< where the drive keeps it: "eeprom", "ram", ...
};

/// A value that the drive itself said.
struct ParameterSeen {
    std::string axis;
    std::string parameter;
    Value value;
    std::int64_t at_unix_ns = 0;
};

/// A write read back: as the newest of its parameter, or as a row of the history.
struct ParameterRecord : StoredParameter {
    std::string storage;
    std::uint64_t id = 0;  ///< number of the history row, counts up; 0 in stored()
};

/// Everything that is stored together: one transaction, one wait for the disk.
struct StoreBatch {
    std::span<const ParameterWrite> writes;
    std::span<const Event> events;
    std::span<const ParameterSeen> seen;
};

/// Answers are in order of id.
using EventFilter = EventQuery;

struct NameChange {
    std::string from;
    std::string to;
};
/// An axis of a site: what is stored for its name holds for one family.
struct SiteAxis {
    std::string name;
    std::string family;  ///< empty: as it was
};
/// What a new site means for what the store knows by name. Done in the same transaction as the site itself, so that a crash cannot
/// leave values under a name that is gone.
struct SiteChange {
    std::vector<NameChange> renamed_axes;
    std::vector<NameChange> renamed_drives;
    /// All axes and drives of the new site, if given: what the store knows beyond them is removed (as remove_axis and remove_drive do).
    std::optional<std::vector<SiteAxis>> axes;
    std::optional<std::vector<std::string>> drives;
    /// Names that are not in it, but not removed yet either.
    std::vector<std::string> kept_axes, kept_drives;
};

struct AxisRecord {
    std::string name;
    std::string family;                           ///< empty: not known
    std::optional<std::int64_t> removed_unix_ns;  ///< set: no longer in the site; what was stored for it is still here
};

/// A small named text of the gateway's own (a recipe, a token's record).
struct StoreDocument {
    std::string kind;
    std::string name;
    std::string text;
    std::string who;
    std::int64_t at_unix_ns = 0;
};

/// A maker's description of a drive (EDS, DCF): its text as it came.
struct StoredDescription {
    std::string name;
    std::string text;
    std::string who;
    std::int64_t at_unix_ns = 0;
};

struct StoreFacts {
    std::string file;
    int version = 0;
    std::uint64_t bytes = 0;             ///< of the database file
    std::uint64_t free_bytes = 0;        ///< of them unused, for new rows
    std::uint64_t wal_bytes = 0;         ///< of the write-ahead log
    std::uint64_t parameter_writes = 0;  ///< rows
    std::uint64_t events = 0;            ///< rows
};

}  // namespace axisgate
