// Plans writes as a whole and carries them out one after the other.
#include "gateway/services/parameters/parameter_writes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "gateway/core/parameter_form.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
json::array left_out_document(const std::vector<ParameterLeftOut>& list) {
    json::array out;
    for (const auto& x : list)
        out.push_back(json::object{{"parameter", x.parameter}, {"why", x.why}});
    return out;
}
}  // namespace

std::string why_left_out(const Parameter& p, WriteBack wanted) {
    if (p.addressing && !wanted.addressing)
        return fmt::format("the drive is reached by it ({}): it is written only with include_addressing", p.name);
    if (p.live && !wanted.live) return fmt::format("it acts at once and is no setting ({}): it is written only with include_live", p.name);
    return {};
}

KnownParameters::KnownParameters(const ParameterPort& parameters, const AxisPlace& axis)
    : parameters_(parameters), catalogue_(axis.catalogue), axis_(axis.id()) {
    for (const auto& s : parameters.stored(axis.spec().name))
        stored_[s.parameter] = s.value;
}

Value KnownParameters::live(const std::string& id) const {
    const auto point = catalogue_ ? catalogue_->find(id) : std::nullopt;
    return point ? parameters_.live(axis_, *point).value : Value{};
}

Value KnownParameters::of(const std::string& id) const {
    if (auto value = live(id); known(value)) return value;
    const auto it = stored_.find(id);
    return it == stored_.end() ? Value{} : it->second;
}

void ParameterPlan::change(std::string id, Point point, Value from, Value to) {
    changes.push_back({id, std::move(from), to});
    points.push_back({std::move(id), point, std::move(to)});
}

json::object document_of(const ParameterPlan& plan) {
    json::array changes;
    for (const auto& x : plan.changes)
        changes.push_back(json::object{{"parameter", x.parameter}, {"from", to_json(x.from)}, {"to", to_json(x.to)}});
    return {{"dry_run", true}, {"changes", std::move(changes)}, {"skipped", left_out_document(plan.left_out)}};
}

json::object document_of(const WrittenParameters& written) {
    json::array changed;
    for (const auto& v : written.changed)
        changed.push_back(json::object{{"parameter", v.parameter}, {"value", to_json(v.value)}});
    return {{"skipped", left_out_document(written.left_out)},
            {"dry_run", false},
            {"changed", std::move(changed)},
            {"failed", document_of(written.failed)}};
}

json::array document_of(const std::vector<JobFailure>& failures) {
    json::array out;
    for (const auto& f : failures)
        out.push_back(json::object{{"parameter", f.parameter}, {"reason", f.reason}});
    return out;
}

ServiceRefusal job_busy(const std::string& axis) {
    return {ServiceRefusal::Why::in_use, "parameters of this axis are being read or written already: see its snapshot-progress", axis};
}

ServiceRefusal job_broken_off(const JobEnd& end, const std::string& axis, std::string_view consequence, json::object more) {
    return {.why = end.silent ? ServiceRefusal::Why::no_answer : ServiceRefusal::Why::wrong_state,
            .text = fmt::format("{}; {}", end.broken_off, consequence),
            .axis = axis,
            .more = std::move(more)};
}

void write_planned(const std::shared_ptr<AxisJobs>& jobs, AxisPort& axes, const AxisPlace& axis, ParameterPlan plan, const Origin& origin,
                   std::function<void(Refusable<WrittenParameters>)> then) {
    const std::string name = axis.spec().name;
    auto& points = plan.points;
    // Parameters that decide the form of others are written first.
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
        return then(ServiceRefusal{ServiceRefusal::Why::wrong_state, fmt::format("{} before its parameters are written", why), name});
    const bool started = AxisJobs::start(
        jobs, axes, name, axis.id(), std::move(points), true, origin, [then, name, left_out = std::move(plan.left_out)](JobEnd end) {
            WrittenParameters written{left_out, std::move(end.values), std::move(end.failed)};
            if (!end.broken_off.empty())
                return then(job_broken_off(end, name, "what was written stays written, see `changed`", document_of(written)));
            then(std::move(written));
        });
    if (!started) then(job_busy(name));
}

}  // namespace axisgate
