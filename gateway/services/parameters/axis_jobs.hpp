// Reads or writes many parameters of one axis, one after the other through the normal queue, with progress. Values and failures are
// reported once at the end. Polls and commands of others run between the steps; there are no retries, and there is one exchange at a time.
// Bounds: `most_points` per job, one job per axis. A silent drive ends the job at once.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/records.hpp"
#include "gateway/services/ports/axes.hpp"

namespace axisgate {

inline constexpr std::size_t most_points = 8192;

struct JobPoint {
    std::string id;
    Point point;
    Value value{};  ///< the value to write; unknown: read
};
struct JobFailure {
    std::string parameter, reason;
};
struct JobEnd {
    std::vector<SnapshotValue> values;  ///< read, or accepted by the drive
    std::vector<JobFailure> failed;     ///< single failures; the job continued
    std::string broken_off;             ///< the reason why it ended early; empty: it did not
    bool silent = false;                ///< ended early because the drive or its line did not answer
};

/// The reason why many parameters cannot be written to an axis now ("the axis moves: stop it"); empty if they can.
[[nodiscard]] std::string why_not_written(const AxisPicture& picture);

/// The newest job of each axis.
class AxisJobs {
public:
    enum class State : std::uint8_t { running, done, failed };
    struct Progress {
        State state = State::running;
        std::string kind;  ///< "read", "write"
        std::size_t done = 0, of = 0;
        std::string text;
    };
    /// Empty if the axis never had one.
    [[nodiscard]] const Progress* of(const std::string& axis) const;
    /// Returns false if a job is running on this axis already.
    [[nodiscard]] static bool start(const std::shared_ptr<AxisJobs>& jobs, AxisPort& axes, const std::string& axis, AxisId id,
                                    std::vector<JobPoint> points, bool write, Origin origin, std::function<void(JobEnd)> then);

private:
    friend struct AxisJob;
    static constexpr std::size_t most_kept = 2048;  // finished jobs of axes that may be gone; beyond this the list is cleared
    std::map<std::string, std::shared_ptr<Progress>> list_;
};

}  // namespace axisgate
