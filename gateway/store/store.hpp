// Store: the parameter database's only writer: site, acknowledged writes, values last seen, events, snapshots, twins' memory, documents.
// In: batches of plain values from one thread (the cold one). Out: everything that StoreReader reads; errors as values.
// Never acknowledges what is not on the disk, never throws, never overwrites a file it does not understand, and knows no Asio, adapter
// or engine.
//
// Files in the data directory: axisgate.db (SQLite, write-ahead log, -wal and -shm beside it while open), axisgate.lock (held by the one
// process that may write), axisgate.db.before-N (copy before the upgrade to version N), axisgate.db.replaced-N (put aside by a restore).
//
// Durability: a call that returns well has its rows on the disk (one transaction, synchronous=FULL): they survive a crash of the process
// and of the machine. A call that returns an error has changed nothing that can be read now; after a crash that follows at once, the
// refused rows may still turn up, because the disk may have taken them and failed only to say so.
// After a full disk or an I/O error the store stays usable: reads go on, and writes work again as soon as the cause is gone.
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
    /// Makes the directory (0750) and the database (0640) if they are not there, upgrades an older one (after a copy), finishes an
    /// interrupted restore. Errors: in_use (a second process), newer, not_ours, corrupt, disk_full, read_only, cannot_open, io.
    /// A file that is refused is not changed by a byte.
    [[nodiscard]] static StoreResult<std::unique_ptr<Store>> open(const StoreOptions& options);
    ~Store() override;

    // --- site --------------------------------------------------------------------------------------------------------------
    /// Puts the document in force together with what it means for names. The revision's number; a text equal to the one in force is
    /// not stored again and keeps its number.
    [[nodiscard]] StoreResult<std::uint64_t> save_site(std::string_view text, std::string_view who, std::int64_t at_unix_ns,
                                                       const SiteChange& change = {});

    // --- batches -----------------------------------------------------------------------------------------------------------
    /// Everything of the batch or nothing, in one transaction; durable when it returns. The id of its last event, 0 if it has none.
    /// An event whose id is 0 gets the next one; ids that are given must be above all before.
    [[nodiscard]] StoreResult<std::uint64_t> commit(const StoreBatch& batch);
    [[nodiscard]] StoreResult<> commit(std::span<const ParameterWrite> writes);
    [[nodiscard]] StoreResult<std::uint64_t> append_events(std::span<const Event> events);
    /// The newest call wins, whatever the times say (the wall clock may have been set back).
    [[nodiscard]] StoreResult<> record_seen(std::span<const ParameterSeen> seen);

    // --- names -------------------------------------------------------------------------------------------------------------
    /// Stored values, history and snapshots go with the axis. Nothing happens if the store does not know `from`. `conflict` if another
    /// axis has the name `to`; a removed one of that name steps aside ("to (removed 7)").
    [[nodiscard]] StoreResult<> rename_axis(std::string_view from, std::string_view to, std::int64_t at_unix_ns);
    /// What it said last goes. All else stays, is shown to nobody, and is there again when an axis of that name is: its snapshots, and
    /// what was written under the family that the new one has.
    [[nodiscard]] StoreResult<> remove_axis(std::string_view axis, std::int64_t at_unix_ns);

    // --- snapshots ---------------------------------------------------------------------------------------------------------
    /// The snapshot's number. `invalid` for a parameter that is there twice; `conflict` if the axis has max_snapshots of them.
    [[nodiscard]] StoreResult<std::uint32_t> save_snapshot(std::string_view axis, std::string_view name, std::string_view comment,
                                                           std::string_view who, std::int64_t at_unix_ns,
                                                           std::span<const SnapshotValue> values);
    /// not_found if there is none.
    [[nodiscard]] StoreResult<> delete_snapshot(std::string_view axis, std::uint32_t n);

    // --- twins -------------------------------------------------------------------------------------------------------------
    /// Only differences are written; nothing is written if there are none.
    [[nodiscard]] StoreResult<> save_twin(std::string_view drive, const NonVolatile& memory);
    /// The memory of a removed drive's twin goes; the next drive of that name starts from factory state.
    [[nodiscard]] StoreResult<> remove_drive(std::string_view drive);

    // --- documents ---------------------------------------------------------------------------------------------------------
    [[nodiscard]] StoreResult<> save_document(const StoreDocument& document);
    [[nodiscard]] StoreResult<> delete_document(std::string_view kind, std::string_view name);

    // --- descriptions ------------------------------------------------------------------------------------------------------
    /// `conflict` if there is one of that name, or there are max_descriptions: the sites that name one rest on its text.
    [[nodiscard]] StoreResult<> save_description(const StoredDescription& description);
    [[nodiscard]] StoreResult<> delete_description(std::string_view name);

    // --- upkeep ------------------------------------------------------------------------------------------------------------
    /// Moves the log into the file and deletes one piece beyond each bound. For quiet moments (once a minute); commits do both when
    /// they must.
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
