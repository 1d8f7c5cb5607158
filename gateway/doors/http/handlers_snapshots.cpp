// Handlers of snapshots: taken from the drive or from what is stored, compared with anything, restored one parameter at a time.
// In: calls. Out: snapshots, differences, what was changed and what was not and why.
// Never stores half a snapshot: a drive that falls silent gives a refusal that says how far it came.
#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "gateway/core/parameter_form.hpp"
#include "gateway/doors/http/parameter_jobs.hpp"
#include "gateway/services/descriptions/description.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/parameters/axis_jobs.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// Arrays up to this length are part of a snapshot; longer ones (programs, tables) are named in `left_out`.
constexpr std::uint16_t most_elements = 256;

json::object info_document(const SnapshotInfo& s, const std::string& axis) {
    return {{"n", s.n},
            {"axis", axis},
            {"name", s.name},
            {"comment", s.comment},
            {"at", format_time(s.at_unix_ns)},
            {"who", text_or_null(s.who)},
            {"family", text_or_null(s.family)},
            {"values", s.values}};
}
/// The catalogue by which its words are read: that of the family it was taken of, which may not be the axis' any more.
const Catalogue* catalogue_of(const SitePort& sites, const SnapshotInfo& s, const AxisPlace& axis) {
    return s.family.empty() || s.family == axis.family ? axis.catalogue : sites.families().find(s.family).catalogue;
}
json::object snapshot_document(const SitePort& sites, const AxisSnapshot& s, const AxisPlace& axis) {
    json::object o = info_document(s, axis.spec().name);
    const Catalogue* catalogue = catalogue_of(sites, s, axis);
    json::array list;
    for (const auto& v : s.parameters) {
        const auto point = catalogue ? catalogue->find(v.parameter) : std::nullopt;
        const auto* p = point ? catalogue->parameter(*point) : nullptr;
        list.push_back(json::object{{"parameter", v.parameter},
                                    {"name", p ? json::value(p->name) : json::value()},
                                    {"unit", p ? text_or_null(p->unit) : json::value()},
                                    {"value", to_json(v.value)}});
    }
    o["parameters"] = std::move(list);
    return o;
}

std::optional<std::string> text_member(const json::object& body, const char* name, std::size_t low, std::size_t high,
                                       std::vector<Fault>& faults) {
    const auto* v = body.if_contains(name);
    if (!v && low == 0) return std::string();
    if (v && v->is_string() && v->get_string().size() >= low && v->get_string().size() <= high) return std::string(v->get_string());
    faults.push_back({fmt::format("/{}", name),
                      v ? fmt::format("{} must be a text of {} to {} bytes", name, low, high) : fmt::format("{} is missing", name),
                      fmt::format("write a text of {} to {} bytes", low, high)});
    return std::nullopt;
}
void refuse_unknown(const json::object& body, std::initializer_list<std::string_view> allowed, std::vector<Fault>& faults) {
    for (const auto& [k, v] : body) {
        if (std::ranges::find(allowed, std::string_view(k)) == allowed.end())
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "leave it out"});
    }
}

/// A snapshot that was taken or removed, for the list of events.
void note_snapshot(EventPort& events, const SnapshotInfo& s, const std::string& axis, const std::string& who, std::string_view what) {
    Event e;
    e.kind = "snapshot";
    e.axis = axis;
    e.text = fmt::format("snapshot {} \"{}\" {}", s.n, s.name, what);
    e.who = who;
    e.door = std::string(axisgate::name_of(Door::http));
    events.note(std::move(e));
}

/// Everything that can be read; what is too long, and what the catalogue says is no matter for a snapshot (`"snapshot": false`: what it is
/// doing now, on a line that is too slow to ask it all), goes into `left_out`.
std::vector<JobPoint> readable_points(const Catalogue& catalogue, json::array& left_out) {
    std::vector<JobPoint> out;
    const auto all = catalogue.parameters();
    const auto* listed = catalogue.document().if_contains("parameters");
    const json::array* document = listed ? listed->if_array() : nullptr;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Parameter& p = all[i];
        if (!p.readable()) continue;
        const auto index = static_cast<std::uint16_t>(i);
        const auto* wanted =
            document && i < document->size() && (*document)[i].is_object() ? (*document)[i].as_object().if_contains("snapshot") : nullptr;
        const bool kept = !wanted || !wanted->is_bool() || wanted->as_bool();
        if (!kept || p.count > most_elements || out.size() + std::max<std::size_t>(p.count, 1) > most_points) {
            left_out.emplace_back(p.id);
            continue;
        }
        const std::uint32_t first = p.count == 0 ? 0 : p.first, end = p.count == 0 ? 1 : std::uint32_t{p.first} + p.count;
        for (std::uint32_t e = first; e < end; ++e) {
            const Point point{index, static_cast<std::uint16_t>(e)};
            out.push_back({catalogue.id_of(point), point});
        }
    }
    return out;
}

struct Found {
    AxisPlace axis;
    AxisSnapshot snapshot;
};
std::optional<Found> find_snapshot(const Call& c, const SitePort& sites, const SnapshotPort& snapshots, std::optional<Response>& fault) {
    auto axis = find_axis(sites, c.names[0]);
    if (!axis) {
        fault = nothing_named("axis", c.names[0]);
        return std::nullopt;
    }
    const auto n = parse_whole(c.names[1], 1, 0xFFFFFFFF);
    auto s = n ? snapshots.snapshot(c.names[0], static_cast<std::uint32_t>(*n)) : std::nullopt;
    if (!s) {
        fault = nothing_named("snapshot", c.names[1]);
        return std::nullopt;
    }
    return Found{std::move(*axis), std::move(*s)};
}

/// 409 where two sets of parameters are of different families: the same word is another parameter there. Unknown ("") fits all.
std::optional<Response> refuse_foreign(const AxisSnapshot& s, std::string_view family, const std::string& what, const std::string& axis) {
    if (s.family.empty() || family.empty() || s.family == family) return std::nullopt;
    return to_response(
        Problem{.status = 409,
                .reason = "conflict",
                .detail = fmt::format("snapshot {} was taken of a {} drive, {} is of a {}: the same words mean other parameters there", s.n,
                                      s.family, what, family),
                .axis = axis});
}

/// What a parameter of an axis is as far as it is known: said by the drive, else written through the gateway.
std::map<std::string, Value> known_values(const ParameterPort& parameters, const AxisPlace& axis) {
    std::map<std::string, Value> out;
    for (const auto& s : parameters.stored(axis.spec().name))
        out[s.parameter] = s.value;
    return out;
}
Value live_or(const ParameterPort& parameters, const AxisPlace& axis, const std::string& id,
              const std::map<std::string, Value>& otherwise) {
    const auto point = axis.catalogue ? axis.catalogue->find(id) : std::nullopt;
    if (point) {
        if (const auto live = parameters.live(axis.id(), *point); known(live.value)) return live.value;
    }
    const auto it = otherwise.find(id);
    return it == otherwise.end() ? Value{} : it->second;
}
bool same(const Value& a, const Value& b) {
    const auto x = as_number(a), y = as_number(b);
    return x && y ? *x == *y : a == b;
}

/// What is missing on the other side, for people: a value that is not known is not one that differs.
std::string unknown_text(std::string_view with, std::size_t unknown, std::size_t all) {
    if (unknown == 0) return {};
    const std::string how_many = unknown == all ? std::string("none of the values") : fmt::format("{} of {} values", unknown, all);
    const std::string is_not = unknown == all ? "is" : "are not";
    if (with == "device") return fmt::format("{} {} be read from the drive", how_many, unknown == all ? "could" : "could not");
    if (with == "stored") return fmt::format("{} {} kept here: only what was written through the gateway is", how_many, is_not);
    if (with.starts_with("axis:") && std::ranges::count(with, ':') == 1)
        return fmt::format("{} {} known of {}: it was not read since the gateway's start; take a snapshot of it and compare with that",
                           how_many, is_not, with.substr(5));
    return fmt::format("{} {} in {}", how_many, is_not, with);
}

json::object diff_document(const SitePort& sites, const Found& f, std::string_view with, const std::map<std::string, Value>& other) {
    const Catalogue* catalogue = catalogue_of(sites, f.snapshot, f.axis);
    json::array rows, live;
    std::size_t unknown = 0;
    std::set<std::string> ids;
    for (const auto& v : f.snapshot.parameters)
        ids.insert(v.parameter);
    for (const auto& [id, v] : other)
        ids.insert(id);
    for (const auto& id : ids) {
        const auto mine = std::ranges::find(f.snapshot.parameters, id, &SnapshotValue::parameter);
        const auto theirs = other.find(id);
        const Value a = mine == f.snapshot.parameters.end() ? Value{} : mine->value;
        const Value b = theirs == other.end() ? Value{} : theirs->second;
        const auto point = catalogue ? catalogue->find(id) : std::nullopt;
        const auto* p = point ? catalogue->parameter(*point) : nullptr;
        // What acts at once is shown apart: it is no setting, and that it is another now is no difference.
        auto& list = p && p->live ? live : rows;
        const bool other_known = known(b);
        if (!other_known) ++unknown;
        list.push_back(json::object{{"parameter", id},
                                    {"name", p ? json::value(p->name) : json::value()},
                                    {"unit", p ? text_or_null(p->unit) : json::value()},
                                    {"snapshot", to_json(a)},
                                    {"other", to_json(b)},
                                    {"other_known", other_known},
                                    {"same", same(a, b)},
                                    {"writable", p && p->writable()}});
    }
    const std::string text = with == "default" ? std::string() : unknown_text(with, unknown, ids.size());
    return {{"with", with}, {"not_known", unknown}, {"text", text}, {"rows", std::move(rows)}, {"live", std::move(live)}};
}
std::map<std::string, Value> as_map(const std::vector<SnapshotValue>& list) {
    std::map<std::string, Value> out;
    for (const auto& v : list)
        out[v.parameter] = v.value;
    return out;
}

/// The values in the maker's description of the drive, as a file that CANopen tools read.
Response as_dcf(const Found& found, const DescriptionPort& port, const SiteState& state, const Families& families) {
    const auto& axis = found.axis.spec();
    const DriveSpec* drive = state.site.drive(axis.drive);
    const auto description = drive ? port.descriptions().find(drive->description) : nullptr;
    if (!description || !found.axis.catalogue)
        return problem(409, "conflict",
                       fmt::format("a DCF is made of a maker's description, and the drive of axis {} names none", axis.name));
    if (auto refusal = refuse_foreign(found.snapshot, found.axis.family, "axis " + axis.name, axis.name)) return *std::move(refusal);
    const auto read = descriptions::read(description->text);
    if (!read.eds) return problem(409, "conflict", fmt::format("description {} cannot be read any more", description->name));
    const LineSpec* line = state.site.line(drive->line);
    const Family* family = families.find(found.axis.family).family;
    const auto bit_rate = line && line->bitrate != 0 ? line->bitrate : family ? family->default_can_bit_rate : 0;
    const auto node = parse_whole(drive->address, 1, 127).value_or(0);
    auto dcf =
        descriptions::dcf_of(*read.eds, *found.axis.catalogue, found.snapshot, static_cast<std::uint8_t>(node), drive->name, bit_rate);
    Response r;
    r.headers.set("Content-Type", "text/plain; charset=utf-8");
    r.headers.set("Content-Disposition", fmt::format("attachment; filename=\"{}-{}.dcf\"", axis.name, found.snapshot.n));
    r.headers.set("Vary", "Accept");
    r.headers.set("Left-Out", std::to_string(dcf.left_out.size()));
    r.body = std::move(dcf.text);
    return r;
}
}  // namespace

Handled list_snapshots(Call& c, const SitePort& sites, const SnapshotPort& snapshots) {
    const auto axis = find_axis(sites, c.names[0]);
    if (!axis) return nothing_named("axis", c.names[0]);
    json::array out;
    for (const auto& s : snapshots.snapshots(c.names[0]))
        out.push_back(info_document(s, c.names[0]));
    return json_response(out);
}

Handled get_snapshot_progress(Call& c, const SitePort& sites) {
    if (!find_axis(sites, c.names[0])) return nothing_named("axis", c.names[0]);
    const auto* p = c.context.jobs->of(c.names[0]);
    if (!p)
        return json_response(
            json::object{{"state", "none"}, {"kind", json::value()}, {"done", std::uint64_t{0}}, {"of", std::uint64_t{0}}, {"text", ""}});
    const auto state = p->state == AxisJobs::State::running ? "running" : p->state == AxisJobs::State::done ? "done" : "failed";
    return json_response(json::object{{"state", state}, {"kind", p->kind}, {"done", p->done}, {"of", p->of}, {"text", p->text}});
}

Handled take_snapshot(Call& c, AxisPort& axes, const ClockPort& clock, EventPort& events, const ParameterPort& parameters,
                      const SitePort& sites, SnapshotPort& snapshots) {
    const auto axis = find_axis(sites, c.names[0]);
    if (!axis) return nothing_named("axis", c.names[0]);
    const auto& body = c.body.get_object();
    std::vector<Fault> faults;
    refuse_unknown(body, {"name", "comment", "from"}, faults);
    auto name = text_member(body, "name", 1, 256, faults);
    auto comment = text_member(body, "comment", 0, 65'536, faults);
    const auto* from = body.if_contains("from");
    const bool stored = from && *from == json::value("stored");
    if (from && !stored && *from != json::value("device"))
        faults.push_back({"/from", "from must be device or stored", "write \"device\" or \"stored\""});
    if (!faults.empty()) return invalid(std::move(faults), c.names[0]);
    AxisSnapshot s;
    s.name = std::move(*name);
    s.comment = std::move(*comment);
    s.who = c.who();
    s.family = axis->family;
    s.at_unix_ns = clock.now_unix_ns();
    auto save = [&events, &sites, &snapshots, axis = *axis, respond = c.respond](AxisSnapshot taken, json::array left_out,
                                                                                 json::array not_read) {
        if (!find_axis(sites, axis.spec().name)) return respond(nothing_named("axis", axis.spec().name));  // removed while it was read
        taken.values = taken.parameters.size();
        snapshots.save_snapshot(
            taken, axis.spec().name,
            [&events, &sites, respond, axis, taken, left_out = std::move(left_out), not_read = std::move(not_read)](
                std::uint32_t n, const std::string& fault, bool axis_gone) mutable {
                if (axis_gone) return respond(nothing_named("axis", axis.spec().name));
                if (!fault.empty()) return respond(problem(507, "not_stored", fault));
                taken.n = n;
                note_snapshot(events, taken, axis.spec().name, taken.who, fmt::format("taken: {} values", taken.values));
                json::object o = snapshot_document(sites, taken, axis);
                o["left_out"] = std::move(left_out);
                o["not_read"] = std::move(not_read);
                Response r = json_response(o, 201);
                r.headers.set("Location", fmt::format("/api/v1/axes/{}/snapshots/{}", percent_encode(axis.spec().name), n));
                respond(std::move(r));
            });
    };
    if (stored) {
        for (const auto& v : parameters.stored(c.names[0]))
            s.parameters.push_back({v.parameter, v.value});
        save(std::move(s), {}, {});
        return {gateway_limit, problem(504, "time_out", "the snapshot was not stored in time: look at the list before trying again")};
    }
    json::array left_out;
    auto points = axis->catalogue ? readable_points(*axis->catalogue, left_out) : std::vector<JobPoint>();
    const bool started =
        AxisJobs::start(c.context.jobs, axes, c.names[0], axis->id(), std::move(points), false, c.origin(),
                        [save, s, left_out, &sites, respond = c.respond, name = c.names[0]](JobEnd end) mutable {
                            if (!end.broken_off.empty() && !find_axis(sites, name)) return respond(nothing_named("axis", name));
                            if (!end.broken_off.empty())
                                return respond(job_broken_off(end, name, "no snapshot was stored", {{"read", end.values.size()}}));
                            s.parameters = std::move(end.values);
                            save(std::move(s), std::move(left_out), job_failures(end.failed));
                        });
    return started ? job_later(c.names[0]) : Handled(job_busy(c.names[0]));
}

Handled get_snapshot(Call& c, const DescriptionPort& descriptions, const SitePort& sites, const SnapshotPort& snapshots) {
    std::optional<Response> fault;
    const auto found = find_snapshot(c, sites, snapshots, fault);
    if (fault) return *fault;
    const auto format = c.target.query.get("format");
    if (format && *format != "dcf" && *format != "json") return problem(400, "bad_request", "format must be dcf or json");
    static constexpr std::string_view media[] = {"application/json", "text/plain"};
    const auto liked = best_accepted(c.request.headers.get("Accept"), media);
    if (!format && !liked) return problem(406, "not_acceptable", "this is application/json or text/plain");
    if (format ? *format == "json" : *liked == 0) return json_response(snapshot_document(sites, found->snapshot, found->axis));
    return as_dcf(*found, descriptions, *sites.site(), sites.families());
}

Handled remove_snapshot(Call& c, EventPort& events, const SitePort& sites, SnapshotPort& snapshots) {
    std::optional<Response> fault;
    const auto found = find_snapshot(c, sites, snapshots, fault);
    if (fault) return *fault;
    snapshots.delete_snapshot(
        c.names[0], found->snapshot.n,
        [&events, info = SnapshotInfo(found->snapshot), axis = c.names[0], who = c.who(), respond = c.respond](const std::string& wrong) {
            if (!wrong.empty()) return respond(problem(507, "not_stored", wrong));
            note_snapshot(events, info, axis, who, "removed");
            Response r;
            r.status = 204;
            respond(std::move(r));
        });
    return {gateway_limit, problem(504, "time_out", "the snapshot was not removed in time")};
}

Handled diff_snapshot(Call& c, AxisPort& axes, const ParameterPort& parameters, const SitePort& sites, const SnapshotPort& snapshots) {
    std::optional<Response> fault;
    auto found = find_snapshot(c, sites, snapshots, fault);
    if (fault) return *fault;
    const std::string with(c.target.query.get("with").value_or("device"));
    const auto shown = [&](const std::map<std::string, Value>& other) { return json_response(diff_document(sites, *found, with, other)); };
    const auto foreign = [&](std::string_view family, const std::string& what) {
        fault = refuse_foreign(found->snapshot, family, what, c.names[0]);
        return fault.has_value();
    };
    const bool elsewhere = with.starts_with("snapshot:") || with.starts_with("axis:");
    if (!elsewhere && foreign(found->axis.family, "axis " + c.names[0])) return *fault;
    if (with == "default") {
        std::map<std::string, Value> other;
        for (const auto& v : found->snapshot.parameters) {
            const auto point = found->axis.catalogue ? found->axis.catalogue->find(v.parameter) : std::nullopt;
            if (const auto* p = point ? found->axis.catalogue->parameter(*point) : nullptr) other[v.parameter] = p->factory_default;
        }
        return shown(other);
    }
    if (with == "stored") return shown(known_values(parameters, found->axis));
    if (with.starts_with("snapshot:")) {
        const auto n = parse_whole(std::string_view(with).substr(9), 1, 0xFFFFFFFF);
        const auto other = n ? snapshots.snapshot(c.names[0], static_cast<std::uint32_t>(*n)) : std::nullopt;
        if (!other) return nothing_named("snapshot", with.substr(9));
        if (foreign(other->family, with)) return *fault;
        return shown(as_map(other->parameters));
    }
    if (with.starts_with("axis:")) {
        std::string name = with.substr(5), number;
        auto other = find_axis(sites, name);
        if (const auto colon = name.rfind(':'); !other && colon != std::string::npos) {
            number = name.substr(colon + 1);
            name.resize(colon);
            other = find_axis(sites, name);
        }
        if (!other) return nothing_named("axis", name);
        if (!number.empty()) {
            const auto n = parse_whole(number, 1, 0xFFFFFFFF);
            const auto s = n ? snapshots.snapshot(name, static_cast<std::uint32_t>(*n)) : std::nullopt;
            if (!s) return nothing_named("snapshot", number);
            if (foreign(s->family.empty() ? other->family : s->family, with)) return *fault;
            return shown(as_map(s->parameters));
        }
        if (foreign(other->family, "axis " + name)) return *fault;
        std::map<std::string, Value> values;
        const auto stored = known_values(parameters, *other);
        for (const auto& v : found->snapshot.parameters)
            values[v.parameter] = live_or(parameters, *other, v.parameter, stored);
        return shown(values);
    }
    if (with != "device") return bad_query("with", "default, device, stored, snapshot:N, axis:NAME or axis:NAME:N");
    std::vector<JobPoint> points;
    for (const auto& v : found->snapshot.parameters) {
        if (const auto point = found->axis.catalogue ? found->axis.catalogue->find(v.parameter) : std::nullopt)
            points.push_back({v.parameter, *point});
    }
    const bool started = AxisJobs::start(c.context.jobs, axes, c.names[0], found->axis.id(), std::move(points), false, c.origin(),
                                         [&sites, found = *found, with, respond = c.respond](const JobEnd& end) {
                                             if (!end.broken_off.empty())
                                                 return respond(job_broken_off(end, found.axis.spec().name, "nothing was compared"));
                                             respond(json_response(diff_document(sites, found, with, as_map(end.values))));
                                         });
    if (!started) return job_busy(c.names[0]);
    return {gateway_limit, problem(504, "time_out", "the drive's parameters were not all read in time")};
}

Handled restore_snapshot(Call& c, AxisPort& axes, const ParameterPort& parameters, const SitePort& sites, const SnapshotPort& snapshots) {
    std::optional<Response> fault;
    const auto found = find_snapshot(c, sites, snapshots, fault);
    if (fault) return *fault;
    if (auto refused = refuse_foreign(found->snapshot, found->axis.family, "axis " + c.names[0], c.names[0])) return *refused;
    const auto& body = c.body.get_object();
    std::vector<Fault> faults;
    refuse_unknown(body, {"parameters", "dry_run", "include_addressing", "include_live"}, faults);
    const auto flag = [&](std::string_view key) {
        const auto* v = body.if_contains(key);
        if (v && !v->is_bool())
            faults.push_back({fmt::format("/{}", key), fmt::format("{} must be true or false", key), "write true or false"});
        return v && v->is_bool() && v->get_bool();
    };
    const bool dry_run = flag("dry_run");
    const WriteBack include{flag("include_addressing"), flag("include_live")};
    std::optional<std::set<std::string>> wanted;
    if (const auto* list = body.if_contains("parameters"); list && list->is_array()) {
        wanted.emplace();
        for (std::size_t i = 0; i < list->get_array().size(); ++i) {
            const auto& v = list->get_array()[i];
            const bool there = v.is_string() && std::ranges::find(found->snapshot.parameters, std::string(v.get_string()),
                                                                  &SnapshotValue::parameter) != found->snapshot.parameters.end();
            if (there)
                wanted->insert(std::string(v.get_string()));
            else
                faults.push_back({fmt::format("/parameters/{}", i), "this is no parameter of the snapshot",
                                  "name parameters by their id, as the snapshot does"});
        }
    } else if (list) {
        faults.push_back({"/parameters", "parameters must be a list of ids", "leave it out for all of them"});
    }
    if (!faults.empty()) return invalid(std::move(faults), c.names[0]);
    if (found->snapshot.family.empty()) {  // from before it was told: it fits as long as every word of it does
        for (const auto& v : found->snapshot.parameters) {
            if (!found->axis.catalogue || found->axis.catalogue->find(v.parameter)) continue;
            return to_response(Problem{
                .status = 409,
                .reason = "conflict",
                .detail = fmt::format("snapshot {} does not tell of which family it is, and a {} has no {}: it is not written to it",
                                      found->snapshot.n, found->axis.family, v.parameter),
                .axis = c.names[0]});
        }
    }
    json::array changes, skipped;
    std::vector<JobPoint> points;
    const auto stored = known_values(parameters, found->axis);
    for (const auto& v : found->snapshot.parameters) {
        if (wanted && !wanted->contains(v.parameter)) continue;
        const auto skip = [&](std::string_view why) { skipped.push_back(json::object{{"parameter", v.parameter}, {"why", why}}); };
        const auto point = found->axis.catalogue ? found->axis.catalogue->find(v.parameter) : std::nullopt;
        const auto* p = point ? found->axis.catalogue->parameter(*point) : nullptr;
        if (!p) {
            skip("the axis has no such parameter now");
            continue;
        }
        if (!p->writable()) {
            skip("can only be read");
            continue;
        }
        // What the snapshot itself gives another parameter counts before what that has now: it will have been written.
        auto checked = check_write_now(*found->axis.catalogue, *point, v.value, [&](Point other) {
            const auto id = found->axis.catalogue->id_of(other);
            const auto it = std::ranges::find(found->snapshot.parameters, id, &SnapshotValue::parameter);
            const bool written = it != found->snapshot.parameters.end() && (!wanted || wanted->contains(id));
            return written ? it->value : live_or(parameters, found->axis, id, stored);
        });
        if (!checked.fault.empty()) {
            skip(checked.fault);
            continue;
        }
        const Value now = live_or(parameters, found->axis, v.parameter, stored);
        if (known(now) && same(now, checked.value)) {
            skip("has this value already");
            continue;
        }
        if (const auto why = why_left_out(*p, include); !why.empty()) {
            skip(why);
            continue;
        }
        changes.push_back(json::object{{"parameter", v.parameter}, {"from", to_json(now)}, {"to", to_json(checked.value)}});
        points.push_back({v.parameter, *point, std::move(checked.value)});
    }
    if (dry_run) return json_response(json::object{{"dry_run", true}, {"changes", std::move(changes)}, {"skipped", std::move(skipped)}});
    return write_parameters(c, axes, found->axis, std::move(points), {{"skipped", std::move(skipped)}});
}

}  // namespace axisgate::http
