// The values of a snapshot are read as one job and stored as a whole. Drives are written only by a plan.
#include "gateway/services/parameters/snapshots.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/core/parameter_form.hpp"
#include "gateway/core/text.hpp"
#include "gateway/services/descriptions/description.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/parameters/drive_sweep.hpp"

namespace axisgate {
namespace json = boost::json;

Refusable<std::vector<SnapshotInfo>> Snapshots::list(const std::string& axis) const {
    if (!find_axis(ports_.get<SitePort>(), axis)) return no_such("axis", axis);
    return ports_.get<SnapshotPort>().snapshots(axis);
}

Refusable<KeptSnapshot> Snapshots::find(const std::string& axis, std::string_view number) const {
    auto place = find_axis(ports_.get<SitePort>(), axis);
    if (!place) return no_such("axis", axis);
    const auto n = parse_whole(number, 1, 0xFFFFFFFF);
    auto s = n ? ports_.get<SnapshotPort>().snapshot(axis, static_cast<std::uint32_t>(*n)) : std::nullopt;
    if (!s) return no_such("snapshot", number);
    return KeptSnapshot{std::move(*place), std::move(*s)};
}

/// The catalogue for its parameters: that of the family of which it was taken, which may differ from the present one of the axis.
const Catalogue* Snapshots::catalogue_of(const KeptSnapshot& kept) const {
    const auto& family = kept.snapshot.family;
    return family.empty() || family == kept.axis.family ? kept.axis.catalogue : ports_.get<SitePort>().families().find(family).catalogue;
}

json::object Snapshots::document(const KeptSnapshot& kept) const {
    json::object o = document_of(kept.snapshot, kept.axis.spec().name);
    const Catalogue* catalogue = catalogue_of(kept);
    json::array values;
    for (const auto& v : kept.snapshot.parameters) {
        const auto point = catalogue ? catalogue->find(v.parameter) : std::nullopt;
        const auto* p = point ? catalogue->parameter(*point) : nullptr;
        values.push_back(json::object{{"parameter", v.parameter},
                                      {"name", p ? json::value(p->name) : json::value()},
                                      {"unit", p ? text_or_null(p->unit) : json::value()},
                                      {"value", to_json(v.value)}});
    }
    o["parameters"] = std::move(values);
    return o;
}

json::object Snapshots::document(const TakenSnapshot& taken) const {
    json::object o = document(static_cast<const KeptSnapshot&>(taken));
    json::array left_out;
    for (const auto& id : taken.left_out)
        left_out.emplace_back(id);
    o["left_out"] = std::move(left_out);
    o["not_read"] = document_of(taken.not_read);
    return o;
}

/// The values in the maker's description of the drive, as a file for CANopen tools.
Refusable<SnapshotDcf> Snapshots::dcf(const KeptSnapshot& kept) const {
    using Why = ServiceRefusal::Why;
    const auto state = ports_.get<SitePort>().site();
    const auto& axis = kept.axis.spec();
    const DriveSpec* drive = state->site.drive(axis.drive);
    const auto description = drive ? ports_.get<DescriptionPort>().descriptions().find(drive->description) : nullptr;
    if (!description || !kept.axis.catalogue)
        return ServiceRefusal{Why::conflict,
                              fmt::format("a DCF is made of a maker's description, and the drive of axis {} names none", axis.name)};
    if (auto refusal = why_not_restored(kept)) return *std::move(refusal);
    const auto read = descriptions::read(description->text);
    if (!read.eds) return ServiceRefusal{Why::conflict, fmt::format("description {} cannot be read any more", description->name)};
    const LineSpec* line = state->site.line(drive->line);
    const Family* family = ports_.get<SitePort>().families().find(kept.axis.family).family;
    const auto bit_rate = line && line->bitrate != 0 ? line->bitrate : family ? family->default_can_bit_rate : 0;
    const auto node = parse_whole(drive->address, 1, 127).value_or(0);
    auto made =
        descriptions::dcf_of(*read.eds, *kept.axis.catalogue, kept.snapshot, static_cast<std::uint8_t>(node), drive->name, bit_rate);
    return SnapshotDcf{fmt::format("{}-{}.dcf", axis.name, kept.snapshot.n), std::move(made.text), made.left_out.size()};
}

void Snapshots::note(const SnapshotInfo& info, const std::string& axis, const Origin& origin, std::string_view what) const {
    Event e;
    e.kind = "snapshot";
    e.axis = axis;
    e.text = fmt::format("snapshot {} \"{}\" {}", info.n, info.name, what);
    e.who = origin.who ? *origin.who : "";
    e.door = std::string(name_of(origin.door));
    ports_.get<EventPort>().note(std::move(e));
}

void Snapshots::keep(TakenSnapshot taken, const Origin& origin, std::function<void(Refusable<TakenSnapshot>)> then) const {
    const std::string axis = taken.axis.spec().name;
    if (!find_axis(ports_.get<SitePort>(), axis)) return then(no_such("axis", axis));  // the axis was removed during the reading
    taken.snapshot.values = taken.snapshot.parameters.size();
    AxisSnapshot kept = taken.snapshot;
    ports_.get<SnapshotPort>().save_snapshot(std::move(kept), axis,
                                             [self = *this, axis, origin, then = std::move(then), taken = std::move(taken)](
                                                 std::uint32_t n, const std::string& fault, bool axis_gone) mutable {
                                                 if (axis_gone) return then(no_such("axis", axis));
                                                 if (!fault.empty()) return then(ServiceRefusal{ServiceRefusal::Why::not_stored, fault});
                                                 taken.snapshot.n = n;
                                                 self.note(taken.snapshot, axis, origin,
                                                           fmt::format("taken: {} values", taken.snapshot.values));
                                                 then(std::move(taken));
                                             });
}

void Snapshots::take(const std::string& axis, SnapshotWish wish, const Origin& origin,
                     std::function<void(Refusable<TakenSnapshot>)> then) const {
    auto place = find_axis(ports_.get<SitePort>(), axis);
    if (!place) return then(no_such("axis", axis));
    TakenSnapshot taken;
    AxisSnapshot& s = taken.snapshot;
    s.name = std::move(wish.name);
    s.comment = std::move(wish.comment);
    s.who = origin.who ? *origin.who : "";
    s.family = place->family;
    s.at_unix_ns = ports_.get<ClockPort>().now_unix_ns();
    taken.axis = *place;
    if (wish.from_stored) {
        for (const auto& v : ports_.get<ParameterPort>().stored(axis))
            s.parameters.push_back({v.parameter, v.value});
        return keep(std::move(taken), origin, std::move(then));
    }
    auto points = place->catalogue ? readable_points(*place->catalogue, taken.left_out) : std::vector<JobPoint>();
    const bool started =
        AxisJobs::start(jobs_, ports_.get<AxisPort>(), axis, place->id(), std::move(points), false, origin,
                        [self = *this, axis, origin, taken = std::move(taken), then](JobEnd end) mutable {
                            if (!end.broken_off.empty() && !find_axis(self.ports_.get<SitePort>(), axis))
                                return then(no_such("axis", axis));
                            if (!end.broken_off.empty())
                                return then(job_broken_off(end, axis, "no snapshot was stored", {{"read", end.values.size()}}));
                            taken.snapshot.parameters = std::move(end.values);
                            taken.not_read = std::move(end.failed);
                            self.keep(std::move(taken), origin, std::move(then));
                        });
    if (!started) then(job_busy(axis));
}

void Snapshots::remove(const std::string& axis, std::string_view number, const Origin& origin,
                       std::function<void(std::optional<ServiceRefusal>)> then) const {
    const auto found = find(axis, number);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&found)) return then(*refusal);
    const SnapshotInfo& info = std::get<KeptSnapshot>(found).snapshot;
    ports_.get<SnapshotPort>().delete_snapshot(axis, info.n,
                                               [self = *this, info, axis, origin, then = std::move(then)](const std::string& wrong) {
                                                   if (!wrong.empty()) return then(ServiceRefusal{ServiceRefusal::Why::not_stored, wrong});
                                                   self.note(info, axis, origin, "removed");
                                                   then(std::nullopt);
                                               });
}

std::optional<ServiceRefusal> Snapshots::why_not_restored(const KeptSnapshot& kept) const {
    return foreign(kept.snapshot, kept.axis.family, "axis " + kept.axis.spec().name, kept.axis.spec().name);
}

Refusable<ParameterPlan> Snapshots::plan_restore(const KeptSnapshot& kept, const RestoreWish& wish) const {
    const AxisPlace& axis = kept.axis;
    const AxisSnapshot& snapshot = kept.snapshot;
    if (snapshot.family.empty()) {  // an older snapshot without a family is accepted if every parameter exists
        for (const auto& v : snapshot.parameters) {
            if (!axis.catalogue || axis.catalogue->find(v.parameter)) continue;
            return ServiceRefusal{
                ServiceRefusal::Why::conflict,
                fmt::format("snapshot {} does not tell of which family it is, and a {} has no {}: it is not written to it", snapshot.n,
                            axis.family, v.parameter),
                axis.spec().name};
        }
    }
    ParameterPlan plan;
    const KnownParameters known_values(ports_.get<ParameterPort>(), axis);
    const auto meant = [&](const std::string& id) { return !wish.parameters || wish.parameters->contains(id); };
    for (const auto& v : snapshot.parameters) {
        if (!meant(v.parameter)) continue;
        const auto skip = [&](std::string why) { plan.left_out.push_back({v.parameter, std::move(why)}); };
        const auto point = axis.catalogue ? axis.catalogue->find(v.parameter) : std::nullopt;
        const auto* p = point ? axis.catalogue->parameter(*point) : nullptr;
        if (!p) {
            skip("the axis has no such parameter now");
            continue;
        }
        if (!p->writable()) {
            skip("can only be read");
            continue;
        }
        // The snapshot's own value of another parameter counts before its present value, because it will have been written by then.
        auto checked = check_write_now(*axis.catalogue, *point, v.value, [&](Point other) {
            const auto id = axis.catalogue->id_of(other);
            const auto it = std::ranges::find(snapshot.parameters, id, &SnapshotValue::parameter);
            return it != snapshot.parameters.end() && meant(id) ? it->value : known_values.of(id);
        });
        if (!checked.fault.empty()) {
            skip(checked.fault);
            continue;
        }
        Value now = known_values.of(v.parameter);
        if (known(now) && equal_values(now, checked.value)) {
            skip("has this value already");
            continue;
        }
        if (auto why = why_left_out(*p, wish.include); !why.empty()) {
            skip(std::move(why));
            continue;
        }
        plan.change(v.parameter, *point, std::move(now), std::move(checked.value));
    }
    return plan;
}

void Snapshots::restore(const KeptSnapshot& kept, ParameterPlan plan, const Origin& origin,
                        std::function<void(Refusable<WrittenParameters>)> then) const {
    write_planned(jobs_, ports_.get<AxisPort>(), kept.axis, std::move(plan), origin, std::move(then));
}

Refusable<json::object> job_progress(const SitePort& sites, const AxisJobs& jobs, const std::string& axis) {
    if (!find_axis(sites, axis)) return no_such("axis", axis);
    const auto* p = jobs.of(axis);
    if (!p)
        return json::object{{"state", "none"}, {"kind", json::value()}, {"done", std::uint64_t{0}}, {"of", std::uint64_t{0}}, {"text", ""}};
    const auto state = p->state == AxisJobs::State::running ? "running" : p->state == AxisJobs::State::done ? "done" : "failed";
    return json::object{{"state", state}, {"kind", p->kind}, {"done", p->done}, {"of", p->of}, {"text", p->text}};
}

}  // namespace axisgate
