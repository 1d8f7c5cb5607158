// The only writer of the database: site, acknowledged writes, reported values, events, snapshots, twins' memory, documents. It gets batches
// of plain values from one thread (the storage thread); errors are values. Nothing is acknowledged before it is on the disk, and a file
// that the store does not understand is never overwritten.
//
// Files in the data directory: axisgate.db (SQLite, write-ahead log, with -wal and -shm while open), axisgate.lock (held by the one process
// that may write), axisgate.db.before-N (copy before the upgrade to version N), axisgate.db.replaced-N (replaced by a restore).
//
// Durability: when a call returns without an error, its rows are on the disk (one transaction, synchronous=FULL) and survive a crash of the
// process and of the machine. A call that returns an error has changed nothing that can be read now. After a crash that follows at once the
// refused rows may be present, because the disk may have stored them and failed only to report it. After a full disk or an I/O error the
// store stays usable: reads continue, and writes work again as soon as the cause is gone.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/twin.hpp"
#include "gateway/store/reader.hpp"
#include "gateway/store/records.hpp"

namespace axisgate {

class Store final : public StoreReader {
public:
    /// Makes the directory (0750) and the database (0640) if they do not exist, upgrades an older one (after a copy), finishes an
    /// interrupted restore. Errors: in_use (a second process), newer, not_ours, corrupt, disk_full, read_only, cannot_open, io. A refused
    /// file is not changed.
    [[nodiscard]] static StoreResult<std::unique_ptr<Store>> open(const StoreOptions& options);
    ~Store() override;

    // --- site --------------------------------------------------------------------------------------------------------------
    // Puts the document in force together with its consequences for names. Returns the revision's number; a text equal to the one in force
    // is not stored again and keeps its number.
    [[nodiscard]] StoreResult<std::uint64_t> save_site(std::string_view text, std::string_view who, std::int64_t at_unix_ns,
                                                       const SiteChange& change = {});

    // --- batches -----------------------------------------------------------------------------------------------------------
    // Stores everything of the batch or nothing, in one transaction; durable when it returns. Returns the id of its last event, 0 if it has
    // none. An event whose id is 0 gets the next one; given ids must be above all earlier ones.
    [[nodiscard]] StoreResult<std::uint64_t> commit(const StoreBatch& batch);
    [[nodiscard]] StoreResult<> commit(std::span<const ParameterWrite> writes);
    [[nodiscard]] StoreResult<std::uint64_t> append_events(std::span<const Event> events);
    /// The newest call wins, independent of the times (the wall clock may have been set back).
    [[nodiscard]] StoreResult<> record_seen(std::span<const ParameterSeen> seen);

    // --- names -------------------------------------------------------------------------------------------------------------
    // Stored values, history and snapshots stay with the axis. Nothing happens if the store does not know `from`. `conflict` if another
    // axis has the name `to`; a removed one of that name is renamed ("to (removed 7)").
    [[nodiscard]] StoreResult<> rename_axis(std::string_view from, std::string_view to, std::int64_t at_unix_ns);
    /// Deletes the last reports. All other data stay hidden, and are available again with an axis of that name: its snapshots, and the
    /// writes under the family of the new axis.
    [[nodiscard]] StoreResult<> remove_axis(std::string_view axis, std::int64_t at_unix_ns);

    // --- snapshots ---------------------------------------------------------------------------------------------------------
    // Returns the snapshot's number. `invalid` for a duplicate parameter; `conflict` if the axis has max_snapshots of them.
    [[nodiscard]] StoreResult<std::uint32_t> save_snapshot(std::string_view axis, std::string_view name, std::string_view comment,
                                                           std::string_view who, std::int64_t at_unix_ns,
                                                           std::span<const SnapshotValue> values);
    /// not_found if there is none.
    [[nodiscard]] StoreResult<> delete_snapshot(std::string_view axis, std::uint32_t n);

    // --- twins -------------------------------------------------------------------------------------------------------------
    // Only differences are written; nothing is written if there are none.
    [[nodiscard]] StoreResult<> save_twin(std::string_view drive, const NonVolatile& memory);
    /// Deletes the memory of a removed drive's twin; the next drive of that name starts from factory state.
    [[nodiscard]] StoreResult<> remove_drive(std::string_view drive);

    // --- documents ---------------------------------------------------------------------------------------------------------
    [[nodiscard]] StoreResult<> save_document(const StoreDocument& document);
    [[nodiscard]] StoreResult<> delete_document(std::string_view kind, std::string_view name);

    // --- descriptions ------------------------------------------------------------------------------------------------------
    // `conflict` if the name exists, or there are max_descriptions; sites rely on the text of a description.
    [[nodiscard]] StoreResult<> save_description(const StoredDescription& description);
    [[nodiscard]] StoreResult<> delete_description(std::string_view name);

    // --- maintenance -------------------------------------------------------------------------------------------------------
    // Merges the log into the file and deletes one piece beyond each bound. For quiet moments (once a minute); commits do both when they
    // must.
    [[nodiscard]] StoreResult<> tidy();

private:
    explicit Store(StoreOptions options) : StoreReader(std::move(options)) {}
    [[nodiscard]] StoreResult<> create_database();
    [[nodiscard]] StoreResult<> open_database();
    [[nodiscard]] StoreResult<> copy_before_upgrade();
    [[nodiscard]] StoreResult<> settle();
    [[nodiscard]] StoreResult<> forget_empty_axes();
    [[nodiscard]] StoreResult<std::int64_t> axis_id(std::string_view axis);
    [[nodiscard]] StoreResult<> put(const ParameterWrite& write);
    [[nodiscard]] StoreResult<> put(const ParameterSeen& seen);
    [[nodiscard]] StoreResult<std::uint64_t> put(const Event& event);
    [[nodiscard]] StoreResult<> check_event_ids(std::span<const Event> events);
    [[nodiscard]] StoreResult<> prune(std::size_t writes_added, std::size_t events_added);
    [[nodiscard]] StoreResult<> rename_axes(std::span<const NameChange> changes, std::int64_t at_unix_ns, bool site_decides);
    [[nodiscard]] StoreResult<> rename_drives(std::span<const NameChange> changes);
    [[nodiscard]] StoreResult<> keep_only(const SiteChange& change, std::int64_t at_unix_ns);
    [[nodiscard]] StoreResult<> bring_in(const SiteAxis& axis);
    [[nodiscard]] StoreResult<> forget_oldest_axes();
    [[nodiscard]] StoreResult<> set_aside(std::string_view name, std::int64_t at_unix_ns, bool site_decides);
    [[nodiscard]] StoreResult<> mark_removed(std::int64_t id, std::int64_t at_unix_ns);
};

}  // namespace axisgate
