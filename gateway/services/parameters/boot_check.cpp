// One read job for each axis of a drive that answers, and one write job if there are differences. If another job is running on an axis, the
// comparison is left out, and an event says so.
#include "gateway/services/parameters/boot_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/json_read.hpp"
#include "gateway/services/axis_place.hpp"

namespace axisgate {
namespace {
/// 5 and 5.0 are equal, and so are true and 1.
bool same(const Value& a, const Value& b) {
    const auto x = as_number(a), y = as_number(b);
    return x && y ? *x == *y : to_text(a) == to_text(b);
}
/// The values that the DCF of the drive gives to its parameters (ParameterValue).
std::vector<StoredParameter> configured(const Catalogue& catalogue) {
    std::vector<StoredParameter> out;
    const auto* list = catalogue.document().if_contains("configured");
    if (!list) return out;
    for (const auto& v : list->as_array()) {
        StoredParameter s;
        s.parameter = std::string(v.at("parameter").as_string());
        s.value = value_of_json(v.at("value"));
        out.push_back(std::move(s));
    }
    return out;
}
Origin itself() { return {Door::internal, std::make_shared<const std::string>("stored parameters")}; }
}  // namespace

BootCheck::BootCheck(const Needs& ports, std::shared_ptr<AxisJobs> jobs)
    : axes_(ports.get<AxisPort>()),
      events_(ports.get<EventPort>()),
      parameters_(ports.get<ParameterPort>()),
      sites_(ports.get<SitePort>()),
      jobs_(std::move(jobs)) {}

void BootCheck::begin() {
    listening_ = true;
    events_.listen(this);
}
void BootCheck::detach() {
    if (std::exchange(listening_, false)) events_.unlisten(this);
}

void BootCheck::on_event(const Event& e) {
    if (e.kind != "drive" || e.severity != Severity::info || e.drive.empty()) return;
    const auto site = sites_.site();
    if (!site) return;
    for (const AxisSpec& a : site->site.axes)
        if (a.drive == e.drive && a.stored_parameters != StoredParameters::ignore) check(a.name);
}

void BootCheck::check(const std::string& axis) {
    const auto place = find_axis(sites_, axis);
    if (!place || !place->catalogue) return;
    std::vector<JobPoint> stored;
    std::set<std::string_view> taken;
    const auto take = [&](const StoredParameter& s) {
        const auto point = place->catalogue->find(s.parameter);
        const Parameter* p = point ? place->catalogue->parameter(*point) : nullptr;
        if (!p || !p->readable() || !p->writable() || p->live || p->addressing || !known(s.value)) return;
        if (taken.insert(s.parameter).second) stored.push_back({s.parameter, *point, s.value});
    };
    // A value that was written through the gateway is newer than the file.
    const auto written = parameters_.stored(axis), of_file = configured(*place->catalogue);
    for (const auto* list : {&written, &of_file})
        std::ranges::for_each(*list, take);
    if (stored.empty()) return;
    auto points = stored;
    for (JobPoint& p : points)
        p.value = {};
    const bool started = AxisJobs::start(jobs_, axes_, axis, place->id(), std::move(points), false, itself(),
                                         [self = weak_from_this(), axis, stored = std::move(stored)](const JobEnd& end) {
                                             if (const auto me = self.lock(); me && me->listening_) me->compared(axis, stored, end);
                                         });
    if (!started) tell(Severity::warning, axis, "stored parameters were not compared: another job on its parameters runs");
}

void BootCheck::compared(const std::string& axis, const std::vector<JobPoint>& stored, const JobEnd& end) {
    if (!end.broken_off.empty()) return tell(Severity::warning, axis, "stored parameters were not compared: " + end.broken_off);
    std::vector<JobPoint> other;
    std::string names;
    const auto written = parameters_.stored(axis);
    const auto source = [&](const JobPoint& s) {
        return std::ranges::find(written, s.id, &StoredParameter::parameter) != written.end() ? "stored is" : "the DCF has";
    };
    for (const JobPoint& s : stored) {
        const auto has = std::ranges::find(end.values, s.id, &SnapshotValue::parameter);
        if (has == end.values.end() || same(has->value, s.value)) continue;
        if (other.size() < most_named)
            names += fmt::format("{}{} is {}, {} {}", names.empty() ? "" : "; ", s.id, to_text(has->value), source(s), to_text(s.value));
        other.push_back(s);
    }
    if (other.empty()) return;
    if (other.size() > most_named) names += fmt::format("; and {} more", other.size() - most_named);
    const auto place = find_axis(sites_, axis);
    const bool write = place && place->spec().stored_parameters == StoredParameters::write;
    tell(Severity::warning, axis,
         fmt::format("{} of {} stored parameters are others in the drive: {}{}", other.size(), stored.size(), names,
                     write ? ". The stored ones are written" : ""));
    if (!write) return;
    if (const auto why = why_not_written(axes_.picture(place->id())); !why.empty())
        return tell(Severity::warning, axis, "stored parameters were not written: " + why);
    const auto count = other.size();
    const bool started = AxisJobs::start(jobs_, axes_, axis, place->id(), std::move(other), true, itself(),
                                         [self = weak_from_this(), axis, count](const JobEnd& done) {
                                             const auto me = self.lock();
                                             if (!me || !me->listening_) return;
                                             std::string refused = done.broken_off;
                                             for (const JobFailure& f : done.failed)
                                                 refused += fmt::format("{}{}: {}", refused.empty() ? "" : "; ", f.parameter, f.reason);
                                             me->tell(refused.empty() ? Severity::info : Severity::warning, axis,
                                                      fmt::format("{} of {} stored parameters were written{}{}", done.values.size(), count,
                                                                  refused.empty() ? "" : ": ", refused));
                                         });
    if (!started) tell(Severity::warning, axis, "stored parameters were not written: another job on its parameters runs");
}

void BootCheck::tell(Severity severity, const std::string& axis, std::string text) {
    Event e;
    e.severity = severity;
    e.kind = "parameters";
    e.axis = axis;
    e.text = std::move(text);
    events_.note(std::move(e));
}

}  // namespace axisgate
