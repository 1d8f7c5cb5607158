// Comparisons of real drives with their twins while the gateway serves them: the sweep as a job of the axis, the comparison on the thread
// of the rehearsals, its report as a document, and the adoption of a report by the twin. The drive is only read; adopting changes the
// memory of its twin. Bounds: one report for each axis, the newest; one job per axis; frames as far back as the trace of the line reaches.
#pragma once

#include <boost/json/object.hpp>
#include <functional>
#include <memory>
#include <string>

#include "gateway/services/axis_place.hpp"
#include "gateway/services/parameters/axis_jobs.hpp"
#include "gateway/services/parameters/drive_comparison.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/documents.hpp"
#include "gateway/services/ports/drives.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/lines.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/rehearsal.hpp"
#include "gateway/services/refusal.hpp"

namespace axisgate {

/// A value, made where the ports and the jobs are available.
class DriveComparisons {
public:
    using Needs = PortSet<AxisPort, ClockPort, DocumentPort, DrivePort, EventPort, LinePort, RehearsalPort, SitePort>;
    DriveComparisons(const Needs& ports, std::shared_ptr<AxisJobs> jobs) : ports_(ports), jobs_(std::move(jobs)) {}

    /// Each `then` is called once, perhaps at once. Refused if the drive is simulated now, or does not answer. A report in which the drive
    /// stopped answering has a `fault`, and is not kept.
    void compare(const std::string& axis, const Origin& origin, std::function<void(Refusable<boost::json::object>)> then) const;
    /// The newest report of the axis.
    [[nodiscard]] Refusable<boost::json::object> report(const std::string& axis) const;
    /// The twin gets the memory of the newest report. Refused if the axis has another drive by now, or the drive is simulated.
    void adopt(const std::string& axis, const Origin& origin, std::function<void(Refusable<boost::json::object>)> then) const;

private:
    struct Run;
    void swept(const std::shared_ptr<Run>& run, Sweep sweep) const;
    void compared(const std::shared_ptr<Run>& run) const;
    void note(std::string text, const std::string& axis, const Origin& origin) const;

    Needs ports_;
    std::shared_ptr<AxisJobs> jobs_;
};

}  // namespace axisgate
