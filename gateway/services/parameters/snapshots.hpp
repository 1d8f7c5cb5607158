// Sets of an axis' parameters: taken from the drive or from the stored values, compared, restored one parameter at a time, written as a
// maker's DCF. There is an event for each one that is stored or removed. Half a snapshot is never stored: if a drive falls silent, the
// refusal states the progress.
#pragma once

#include <boost/json/object.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/parameters/parameter_writes.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/descriptions.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/snapshots.hpp"

namespace axisgate {

struct SnapshotWish {
    std::string name, comment;
    bool from_stored = false;  ///< true: the values that were written through the gateway; false: the drive's
};
struct RestoreWish {
    std::optional<std::set<std::string>> parameters;  ///< only these
    WriteBack include;
    bool dry_run = false;
};
/// A snapshot and its axis.
struct KeptSnapshot {
    AxisPlace axis;
    AxisSnapshot snapshot;
};
struct TakenSnapshot : KeptSnapshot {
    std::vector<std::string> left_out;  ///< too long, or excluded from snapshots
    std::vector<JobFailure> not_read;
};
struct SnapshotDifference {
    struct Row {
        std::string parameter;
        const Parameter* known_as = nullptr;  ///< by the catalogue of the snapshot's family; null: it has no such parameter
        Value snapshot, other;
    };
    std::string with;
    std::vector<Row> rows;
    std::size_t not_known = 0;  ///< number of unknown values of the other side
    std::string text;           ///< the missing values there, for people
};
struct SnapshotDcf {
    std::string file_name, text;
    std::size_t left_out = 0;  ///< number of values that a DCF of this description cannot contain
};

/// Refuses two sets of parameters of different families, because the same id is another parameter there. An unknown family ("") fits all.
[[nodiscard]] std::optional<ServiceRefusal> foreign(const AxisSnapshot& snapshot, std::string_view family, const std::string& what,
                                                    const std::string& axis);
/// Compared as numbers if both are numbers.
[[nodiscard]] bool equal_values(const Value& a, const Value& b);

/// Reads a body. Faults have their places; if there are any, the returned value has no meaning.
[[nodiscard]] SnapshotWish read_snapshot_wish(const boost::json::object& body, std::vector<Fault>& faults);
[[nodiscard]] RestoreWish read_restore_wish(const boost::json::object& body, const AxisSnapshot& snapshot, std::vector<Fault>& faults);

[[nodiscard]] boost::json::object document_of(const SnapshotInfo& info, const std::string& axis);
[[nodiscard]] boost::json::object document_of(const SnapshotDifference& difference);

/// A value, made where the ports and the jobs are available.
class Snapshots {
public:
    using Needs = PortSet<AxisPort, ClockPort, DescriptionPort, EventPort, ParameterPort, SitePort, SnapshotPort>;
    Snapshots(const Needs& ports, std::shared_ptr<AxisJobs> jobs) : ports_(ports), jobs_(std::move(jobs)) {}

    [[nodiscard]] Refusable<std::vector<SnapshotInfo>> list(const std::string& axis) const;
    [[nodiscard]] Refusable<KeptSnapshot> find(const std::string& axis, std::string_view number) const;
    /// With the names and units of its parameters.
    [[nodiscard]] boost::json::object document(const KeptSnapshot& kept) const;
    [[nodiscard]] boost::json::object document(const TakenSnapshot& taken) const;
    [[nodiscard]] Refusable<SnapshotDcf> dcf(const KeptSnapshot& kept) const;

    /// Each `then` is called once, perhaps at once.
    void take(const std::string& axis, SnapshotWish wish, const Origin& origin, std::function<void(Refusable<TakenSnapshot>)> then) const;
    void remove(const std::string& axis, std::string_view number, const Origin& origin,
                std::function<void(std::optional<ServiceRefusal>)> then) const;
    /// `with`: default, device, stored, snapshot:N, axis:NAME, axis:NAME:N.
    void compare(const std::string& axis, std::string_view number, const std::string& with, const Origin& origin,
                 std::function<void(Refusable<SnapshotDifference>)> then) const;
    /// The writes of a restore; a snapshot of another family is refused.
    [[nodiscard]] Refusable<ParameterPlan> plan_restore(const KeptSnapshot& kept, const RestoreWish& wish) const;
    /// Checks whether it may be restored to its axis at all, before the request is read.
    [[nodiscard]] std::optional<ServiceRefusal> why_not_restored(const KeptSnapshot& kept) const;
    void restore(const KeptSnapshot& kept, ParameterPlan plan, const Origin& origin,
                 std::function<void(Refusable<WrittenParameters>)> then) const;

private:
    void keep(TakenSnapshot taken, const Origin& origin, std::function<void(Refusable<TakenSnapshot>)> then) const;
    void note(const SnapshotInfo& info, const std::string& axis, const Origin& origin, std::string_view what) const;
    [[nodiscard]] const Catalogue* catalogue_of(const KeptSnapshot& kept) const;
    /// The other side of a comparison, as far as it is known without an exchange; empty if the drive must be asked.
    [[nodiscard]] Refusable<std::optional<std::map<std::string, Value>>> other_side(const KeptSnapshot& kept,
                                                                                    const std::string& with) const;
    [[nodiscard]] Refusable<std::optional<std::map<std::string, Value>>> of_axis(const KeptSnapshot& kept, const std::string& with) const;
    [[nodiscard]] SnapshotDifference difference(const KeptSnapshot& kept, const std::string& with,
                                                const std::map<std::string, Value>& other) const;

    Needs ports_;
    std::shared_ptr<AxisJobs> jobs_;
};

/// The newest job of an axis; state "none" if it never had one.
[[nodiscard]] Refusable<boost::json::object> job_progress(const SitePort& sites, const AxisJobs& jobs, const std::string& axis);

}  // namespace axisgate
