// Parameter writes: many values for one axis: what is to be changed and what is left out and why, and the job that writes it.
// In: checked points, what is known of the axis. Out: a plan, its document, what was changed and what was refused. What decides over the
// form of others is written before them. Never begins to write to an axis that moves; a job itself is AxisJobs'.
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

/// What is written back only if it is asked for by name.
struct WriteBack {
    bool addressing = false;  ///< include_addressing
    bool live = false;        ///< include_live
};
/// Why a parameter of the catalogue's `addressing` or `live` is left out when many are written back; empty: it is not.
[[nodiscard]] std::string why_left_out(const Parameter& parameter, WriteBack wanted);

/// What the parameters of an axis are as far as it is known without asking: said by the drive, else written through the gateway.
class KnownParameters {
public:
    KnownParameters(const ParameterPort& parameters, const AxisPlace& axis);
    /// Said by the drive; unknown: it has not been, or there is no such parameter.
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
/// Of a plan that is not carried out: `dry_run`, `changes`, `skipped`.
[[nodiscard]] boost::json::object document_of(const ParameterPlan& plan);

struct WrittenParameters {
    std::vector<ParameterLeftOut> left_out;
    std::vector<SnapshotValue> changed;
    std::vector<JobFailure> failed;
};
[[nodiscard]] boost::json::object document_of(const WrittenParameters& written);
[[nodiscard]] boost::json::array document_of(const std::vector<JobFailure>& failures);

/// Another job of this axis is under way.
[[nodiscard]] ServiceRefusal job_busy(const std::string& axis);
/// How far the job came, and what that means; `more`: further members of the answer.
[[nodiscard]] ServiceRefusal job_broken_off(const JobEnd& end, const std::string& axis, std::string_view consequence,
                                            boost::json::object more = {});

/// Carries the plan out. `then` is called once, perhaps at once.
void write_planned(const std::shared_ptr<AxisJobs>& jobs, AxisPort& axes, const AxisPlace& axis, ParameterPlan plan, const Origin& origin,
                   std::function<void(Refusable<WrittenParameters>)> then);

}  // namespace axisgate
