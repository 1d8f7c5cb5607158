// Parameter jobs: what decides over the form of others is written before them.
// In: points, the axis as it is. Out: what was changed and what was not and why, in one answer.
// Never begins to write to an axis that moves.
#include "gateway/doors/http/parameter_jobs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "gateway/core/parameter_form.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// A job that takes longer goes on, and is asked after at .../snapshot-progress.
constexpr std::chrono::seconds job_wait{20};
}  // namespace

json::array job_failures(const std::vector<JobFailure>& list) {
    json::array out;
    for (const auto& f : list)
        out.push_back(json::object{{"parameter", f.parameter}, {"reason", f.reason}});
    return out;
}
Response job_broken_off(const JobEnd& end, const std::string& axis, std::string_view consequence, json::object more) {
    return to_response(Problem{.status = end.silent ? 504u : 409u,
                               .reason = end.silent ? "no_answer" : "wrong_state",
                               .detail = fmt::format("{}; {}", end.broken_off, consequence),
                               .axis = axis,
                               .more = std::move(more)});
}
Response job_busy(const std::string& axis) {
    return to_response(Problem{.status = 409,
                               .reason = "busy",
                               .detail = "parameters of this axis are being read or written already: see its snapshot-progress",
                               .axis = axis});
}
Handled job_later(const std::string& axis) {
    Response r = json_response(json::object{{"state", "running"}, {"text", "it goes on: ask for its progress"}}, 202);
    r.headers.set("Location", fmt::format("/api/v1/axes/{}/snapshot-progress", percent_encode(axis)));
    return {job_wait, std::move(r)};
}

std::string why_left_out(const Parameter& p, WriteBack wanted) {
    if (p.addressing && !wanted.addressing)
        return fmt::format("the drive is reached by it ({}): it is written only with include_addressing", p.name);
    if (p.live && !wanted.live) return fmt::format("it acts at once and is no setting ({}): it is written only with include_live", p.name);
    return {};
}

Handled write_parameters(Call& c, AxisPort& axes, const AxisPlace& axis, std::vector<JobPoint> points, json::object more) {
    const std::string name = axis.spec().name;
    // What decides over the form of others goes before them.
    if (axis.catalogue) {
        std::set<std::pair<std::uint16_t, std::uint16_t>> deciding;
        for (const auto& p : points) {
            if (const auto a = alternate_of(*axis.catalogue, p.point); a && a->of) deciding.emplace(a->of->parameter, a->of->element);
        }
        std::stable_partition(points.begin(), points.end(), [&](const JobPoint& p) {
            return deciding.contains({p.point.parameter, p.point.element});
        });
    }
    if (const auto why = why_not_written(axes.picture(axis.id())); !points.empty() && !why.empty())
        return to_response(Problem{
            .status = 409, .reason = "wrong_state", .detail = fmt::format("{} before its parameters are written", why), .axis = name});
    const bool started = AxisJobs::start(
        c.context.jobs, axes, name, axis.id(), std::move(points), true, c.origin(),
        [respond = c.respond, name, more = std::move(more)](JobEnd end) {
            json::array changed;
            for (const auto& v : end.values)
                changed.push_back(json::object{{"parameter", v.parameter}, {"value", to_json(v.value)}});
            json::object answer = more;
            answer["dry_run"] = false;
            answer["changed"] = std::move(changed);
            answer["failed"] = job_failures(end.failed);
            if (!end.broken_off.empty())
                return respond(job_broken_off(end, name, "what was written stays written, see `changed`", std::move(answer)));
            respond(json_response(answer));
        });
    return started ? job_later(name) : Handled(job_busy(name));
}

}  // namespace axisgate::http
