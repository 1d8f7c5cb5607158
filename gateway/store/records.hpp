// The input and output of the store as plain values, with their bounds. They contain names and no ids of the running process; times are
// nanoseconds since 1970 (UTC).
//
// Event, EventQuery, StoredParameter, SiteRevision and the snapshots are those of gateway/core/records.hpp; additional members are added by
// derivation, so that a vector of them can be passed on as a vector of the base.
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

/// Bounds of the database. Rows beyond a bound are deleted, oldest first; values that are too long or too many are refused (`invalid`),
/// except that texts of events are cut, because an event must not be lost for its length.
struct StoreLimits {
    std::uint64_t site_revisions = 1000;
    std::uint64_t site_bytes = 256ull << 20;   ///< total size of their documents; the one in force stays whatever its length
    std::uint64_t removed_axes = 1000;         ///< with all of their stored data
    std::uint64_t parameter_writes = 100'000;  ///< rows of the history, of all axes together
    std::uint64_t events = 200'000;
    std::uint64_t piece = 256;                      ///< rows deleted in addition to the number of added ones, per transaction, when a table
                                                    ///< is over its bound
    std::uint64_t max_bytes = 2ull << 30;           ///< size of the database file; 0: limited only by the disk
    std::int64_t seen_refresh_ns = 60'000'000'000;  ///< an unchanged reported value is not written again before this time, to spare flash
                                                    ///< memory
};
inline constexpr std::size_t max_name_bytes = 256;         ///< axis, drive, parameter, snapshot and document names
inline constexpr std::size_t max_value_bytes = 1u << 20;   ///< one text value
inline constexpr std::size_t max_event_text_bytes = 8192;  ///< longer texts are cut, marked with " [...]"
inline constexpr std::size_t max_comment_bytes = 65'536;
inline constexpr std::size_t max_site_bytes = 16u << 20;
inline constexpr std::size_t max_document_bytes = 1u << 20;
inline constexpr std::size_t max_documents = 10'000;  ///< per kind
inline constexpr std::size_t max_description_bytes = 1u << 20;
inline constexpr std::size_t max_descriptions = 200;
inline constexpr std::size_t max_batch_rows = 10'000;       ///< writes, events and reported values of one batch, each
inline constexpr std::size_t max_snapshot_values = 65'536;  ///< also of one twin's memory
inline constexpr std::size_t max_snapshots = 1'000;         ///< per axis
inline constexpr std::uint64_t max_event_id = 1ull << 53;   ///< exact as a JSON number
inline constexpr int steps_between = 100;                   ///< steps of SQLite's virtual machine; writing a row takes some 40
inline constexpr std::size_t max_answer_rows = 10'000;      ///< of history and events; more rows are read in pages

struct StoreOptions {
    std::string directory;
    std::vector<Migration> migrations;  ///< as returned by migrations_among; their SQL text must outlive the call
    StoreLimits limits;
    std::string vfs;  ///< SQLite file layer by name; empty: the default
    /// Called every `steps_between` steps of every statement (some 10 us), also of those that open, check and upgrade the file; may be
    /// nullptr.
    void (*between)() noexcept = nullptr;
};

/// A write that a drive acknowledged.
struct ParameterWrite {
    std::string axis;
    std::string parameter;  ///< catalogue id, with its element for an array: "AC", "N[17]"
    Value value;
    Value previous;  ///< the previous value; unknown if there was none
    Door door = Door::internal;
    std::string who;  ///< "192.0.2.7:51123", "token commissioning"
    std::int64_t at_unix_ns = 0;
    std::string storage;  ///< the drive's storage for it: "eeprom", "ram", ...
};

/// A value that the drive itself reported.
struct ParameterSeen {
    std::string axis;
    std::string parameter;
    Value value;
    std::int64_t at_unix_ns = 0;
};

/// A write as read back: the newest of its parameter, or a row of the history.
struct ParameterRecord : StoredParameter {
    std::string storage;
    std::uint64_t id = 0;  ///< number of the history row, increases; 0 in stored()
};

/// Data that are stored together: one transaction, one wait for the disk.
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
/// An axis of a site; the stored data of its name belong to one family.
struct SiteAxis {
    std::string name;
    std::string family;  ///< empty: unchanged
};
/// The consequences of a new site for data that are stored by name. Applied in the same transaction as the site itself, so that a crash
/// cannot leave values under a name that does not exist any more.
struct SiteChange {
    std::vector<NameChange> renamed_axes;
    std::vector<NameChange> renamed_drives;
    /// All axes and drives of the new site, if given: data of others are removed (as by remove_axis and remove_drive).
    std::optional<std::vector<SiteAxis>> axes;
    std::optional<std::vector<std::string>> drives;
    /// Names that are not in it, but are not to be removed yet.
    std::vector<std::string> kept_axes, kept_drives;
};

struct AxisRecord {
    std::string name;
    std::string family;                           ///< empty: unknown
    std::optional<std::int64_t> removed_unix_ns;  ///< set: no longer in the site; its stored data are still present
};

/// A small named text of the gateway itself (a recipe, a token's record).
struct StoreDocument {
    std::string kind;
    std::string name;
    std::string text;
    std::string who;
    std::int64_t at_unix_ns = 0;
};

/// A maker's description of a drive (EDS, DCF): its unchanged text.
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
    std::uint64_t free_bytes = 0;        ///< unused part, available for new rows
    std::uint64_t wal_bytes = 0;         ///< of the write-ahead log
    std::uint64_t parameter_writes = 0;  ///< rows
    std::uint64_t events = 0;            ///< rows
};

}  // namespace axisgate
