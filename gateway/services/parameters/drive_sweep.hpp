// Reads from a drive everything that can be read without an effect on it, and reads it a second time, so that a value that changes by
// itself or by somebody else is noticed. Nothing is written. Bounds: those of AxisJobs; the drive is asked one question at a time.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/services/parameters/axis_jobs.hpp"

namespace axisgate {

/// All readable parameters, element by element. Long arrays, and parameters that the catalogue excludes from snapshots (`"snapshot":
/// false`: present activity, on a line that is too slow to read everything), are put into `left_out`.
[[nodiscard]] std::vector<JobPoint> readable_points(const Catalogue& catalogue, std::vector<std::string>& left_out);

struct SweepPlan {
    std::vector<JobPoint> points;
    std::vector<JobFailure> left_out;  ///< the parameters that are not asked for, and why
};
/// The readable points without those whose reading has an effect (`"read_effect"` in the catalogue says which).
[[nodiscard]] SweepPlan sweep_plan(const Catalogue& catalogue);

struct Sweep {
    struct Change {
        std::string parameter;
        Value first, second;
    };
    std::vector<SnapshotValue> values;  ///< of the first reading
    std::vector<Change> changed;        ///< the second reading gave another value
    std::vector<JobFailure> not_read;   ///< refused by the drive or its adapter
    std::string broken_off;             ///< the drive stopped answering, and at which parameter; empty: it did not
};
/// Returns false if a job is running on this axis already; otherwise `then` is called once, perhaps at once.
[[nodiscard]] bool start_sweep(const std::shared_ptr<AxisJobs>& jobs, AxisPort& axes, const std::string& axis, AxisId id,
                               const std::vector<JobPoint>& points, const Origin& origin, std::function<void(Sweep)> then);

}  // namespace axisgate
