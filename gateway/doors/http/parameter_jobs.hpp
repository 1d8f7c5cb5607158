// Parameter jobs: the answers of requests that read or write many parameters of one axis, one after the other.
// In: checked points, ends of jobs. Out: Handled; 202 with the place of the progress where a job takes longer than a client waits.
// Never runs a job itself: that is AxisJobs'.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/parameters/axis_jobs.hpp"

namespace axisgate::http {

[[nodiscard]] boost::json::array job_failures(const std::vector<JobFailure>& list);
/// 504 or 409: how far the job came, and what that means; `more`: further members of the answer.
[[nodiscard]] Response job_broken_off(const JobEnd& end, const std::string& axis, std::string_view consequence,
                                      boost::json::object more = {});
/// 409: another job of this axis is under way.
[[nodiscard]] Response job_busy(const std::string& axis);
/// A job has begun: its answer, or 202 when it takes longer.
[[nodiscard]] Handled job_later(const std::string& axis);

/// Writes checked values one after the other; `more`: further members of the answer.
[[nodiscard]] Handled write_parameters(Call& call, AxisPort& axes, const AxisPlace& axis, std::vector<JobPoint> points,
                                       boost::json::object more);
/// What is written back only if it is asked for by name.
struct WriteBack {
    bool addressing = false;  ///< include_addressing
    bool live = false;        ///< include_live
};
/// Why a parameter of the catalogue's `addressing` or `live` is left out when many are written back; empty: it is not.
[[nodiscard]] std::string why_left_out(const Parameter& parameter, WriteBack wanted);

}  // namespace axisgate::http
