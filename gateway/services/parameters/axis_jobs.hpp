// Axis jobs: many parameters of one axis read or written one after the other through the normal queue, with progress.
// In: points, the axis port. Out: values, failures, told once at the end. One job per axis; polls and commands of others go between the
// steps. Never retries and never has two exchanges on the way. Bounded: `most_points` per job, one job per axis; a silent drive ends it at
// once.
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
    Value value{};  ///< to be written; unknown: to be read
};
struct JobFailure {
    std::string parameter, reason;
};
struct JobEnd {
    std::vector<SnapshotValue> values;  ///< read, or taken by the drive
    std::vector<JobFailure> failed;     ///< one by one, the job went on
    std::string broken_off;             ///< why it did not reach its end; empty: it did
    bool silent = false;                ///< broken off because the drive or its line did not answer
};

/// Why many parameters are not written to an axis now ("the axis moves: stop it"); empty: they may be.
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
    /// Nothing if the axis never had one.
    [[nodiscard]] const Progress* of(const std::string& axis) const;
    /// False: one runs on this axis already.
    [[nodiscard]] static bool start(const std::shared_ptr<AxisJobs>& jobs, AxisPort& axes, const std::string& axis, AxisId id,
                                    std::vector<JobPoint> points, bool write, Origin origin, std::function<void(JobEnd)> then);

private:
    friend struct AxisJob;
    static constexpr std::size_t most_kept = 2048;  // finished ones of axes that may be gone; then the list begins anew
    std::map<std::string, std::shared_ptr<Progress>> list_;
};

}  // namespace axisgate
