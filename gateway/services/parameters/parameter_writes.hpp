// Many values for one axis: a plan with changes and skipped values (and reasons), its document, and the job that writes it (AxisJobs).
// Parameters that decide the form of others are written first. A write does not begin while the axis moves.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/axis_place.hpp"
#include "gateway/services/parameters/axis_jobs.hpp"
#include "gateway/services/ports/parameters.hpp"
#include "gateway/services/refusal.hpp"

namespace axisgate {

/// The parameters that are written back only on explicit request.
struct WriteBack {
    bool addressing = false;  ///< include_addressing
    bool live = false;        ///< include_live
};
/// The reason why a parameter with `addressing` or `live` in the catalogue is left out when many are written back; empty if it is not.
[[nodiscard]] std::string why_left_out(const Parameter& parameter, WriteBack wanted);

/// The values of an axis' parameters as far as they are known without an exchange: reported by the drive, otherwise written through the
/// gateway.
class KnownParameters {
public:
    KnownParameters(const ParameterPort& parameters, const AxisPlace& axis);
    /// The drive's report; unknown if there was none, or no such parameter.
    [[nodiscard]] Value live(const std::string& id) const;
    [[nodiscard]] const std::map<std::string, Value>& stored() const noexcept { return stored_; }
    [[nodiscard]] Value of(const std::string& id) const;

private:
    const ParameterPort& parameters_;
    const Catalogue* catalogue_;
    AxisId axis_;
    std::map<std::string, Value> stored_;
};

struct ParameterChange {
    std::string parameter;
    Value from, to;
};
struct ParameterLeftOut {
    std::string parameter, why;
};
struct ParameterPlan {
    std::vector<ParameterChange> changes;
    std::vector<ParameterLeftOut> left_out;
    std::vector<JobPoint> points;  ///< of the changes, in their order

    void change(std::string id, Point point, Value from, Value to);
};
/// For a plan that is not carried out: `dry_run`, `changes`, `skipped`.
[[nodiscard]] boost::json::object document_of(const ParameterPlan& plan);

struct WrittenParameters {
    std::vector<ParameterLeftOut> left_out;
    std::vector<SnapshotValue> changed;
    std::vector<JobFailure> failed;
};
[[nodiscard]] boost::json::object document_of(const WrittenParameters& written);
[[nodiscard]] boost::json::array document_of(const std::vector<JobFailure>& failures);

/// Another job of this axis is running.
[[nodiscard]] ServiceRefusal job_busy(const std::string& axis);
/// The progress of the job and its consequence; `more` has further members of the answer.
[[nodiscard]] ServiceRefusal job_broken_off(const JobEnd& end, const std::string& axis, std::string_view consequence,
                                            boost::json::object more = {});

/// Carries the plan out. `then` is called once, perhaps at once.
void write_planned(const std::shared_ptr<AxisJobs>& jobs, AxisPort& axes, const AxisPlace& axis, ParameterPlan plan, const Origin& origin,
                   std::function<void(Refusable<WrittenParameters>)> then);

}  // namespace axisgate
