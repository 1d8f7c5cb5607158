// Reads from the database over a connection of its own. Readers and the writer do not wait for each other (write-ahead log). One thread at
// a time per reader.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/twin.hpp"
#include "gateway/store/files.hpp"
#include "gateway/store/records.hpp"
#include "gateway/store/sqlite.hpp"

namespace axisgate {

class StoreReader {
public:
    /// Opens the database of a running (or stopped) gateway for reading. Errors: not_found if there is none yet; newer; not_ours; corrupt;
    /// invalid if it is older than this program (the service upgrades it when it starts).
    [[nodiscard]] static StoreResult<std::unique_ptr<StoreReader>> open(const StoreOptions& options);
    virtual ~StoreReader() = default;
    StoreReader(const StoreReader&) = delete;
    StoreReader& operator=(const StoreReader&) = delete;

    // --- site --------------------------------------------------------------------------------------------------------------
    // The document in force; empty if none was ever saved.
    [[nodiscard]] StoreResult<std::optional<SiteRevision>> load_site();
    [[nodiscard]] StoreResult<std::optional<SiteRevision>> site(std::uint64_t revision);
    /// Newest first, without the texts. `limit`: 1..max_answer_rows (clamped). `before`: only smaller numbers, for the next page; 0: from
    /// the newest.
    [[nodiscard]] StoreResult<std::vector<SiteRevision>> site_history(std::size_t limit = max_answer_rows, std::uint64_t before = 0);

    // --- parameters --------------------------------------------------------------------------------------------------------
    // Every axis that the store knows, in order of name, including removed ones.
    [[nodiscard]] StoreResult<std::vector<AxisRecord>> axes();
    /// The newest acknowledged write of each parameter under the present family of the axis, in order of parameter id; none for removed
    /// axes.
    [[nodiscard]] StoreResult<std::vector<ParameterRecord>> stored(std::string_view axis);
    [[nodiscard]] StoreResult<std::optional<ParameterRecord>> stored(std::string_view axis, std::string_view parameter);
    /// Writes under the present (or last) family of the axis, newest first, also of removed axes. `parameter` empty: all of the axis.
    /// `limit`: 1..max_answer_rows (clamped). `before_id`: rows with a smaller id, for the next page; 0: from the newest.
    [[nodiscard]] StoreResult<std::vector<ParameterRecord>> history(std::string_view axis, std::string_view parameter, std::size_t limit,
                                                                    std::uint64_t before_id = 0);
    /// The last reports of the drive, in order of parameter id; none for removed axes.
    [[nodiscard]] StoreResult<std::vector<ParameterSeen>> seen(std::string_view axis);

    // --- snapshots ---------------------------------------------------------------------------------------------------------
    // In order of n, of every family. Those of a removed axis are kept and available again when an axis of that name is made.
    [[nodiscard]] StoreResult<std::vector<SnapshotInfo>> snapshots(std::string_view axis);
    [[nodiscard]] StoreResult<std::optional<AxisSnapshot>> snapshot(std::string_view axis, std::uint32_t n);

    // --- twins -------------------------------------------------------------------------------------------------------------
    // Empty if nothing was saved: factory state.
    [[nodiscard]] StoreResult<NonVolatile> load_twin(std::string_view drive);

    // --- events ------------------------------------------------------------------------------------------------------------
    [[nodiscard]] StoreResult<std::vector<Event>> events(const EventFilter& filter);
    /// The highest id that was ever used, 0 if none; also if that event was deleted.
    [[nodiscard]] StoreResult<std::uint64_t> last_event_id();

    // --- documents ---------------------------------------------------------------------------------------------------------
    [[nodiscard]] StoreResult<std::optional<StoreDocument>> document(std::string_view kind, std::string_view name);
    /// With their texts, in order of name.
    [[nodiscard]] StoreResult<std::vector<StoreDocument>> documents(std::string_view kind);

    // --- descriptions ------------------------------------------------------------------------------------------------------
    /// With their texts, in order of name.
    [[nodiscard]] StoreResult<std::vector<StoredDescription>> descriptions();

    // --- the file ----------------------------------------------------------------------------------------------------------
    // SQLite's integrity check, references between tables, structure. Good, or `corrupt` with the findings. Reads the whole file.
    [[nodiscard]] StoreResult<> check();
    [[nodiscard]] StoreResult<StoreFacts> facts();
    /// As backup_database (gateway/store/backup.hpp). Does not use this reader's connection.
    [[nodiscard]] StoreResult<> backup(const std::string& target);
    [[nodiscard]] const StoreOptions& options() const noexcept { return options_; }
    [[nodiscard]] const std::string& directory() const noexcept { return files_.directory; }

protected:
    explicit StoreReader(StoreOptions options) : options_(std::move(options)), files_(options_.directory) {}

    StoreOptions options_;
    StoreFiles files_;
    std::optional<DirectoryLock> lock_;  // before db_, so that the database is closed before another process can get the lock
    std::unique_ptr<Db> db_;
};

}  // namespace axisgate
