// A report is kept with the memory that its twin would get, which is not shown.
#include "gateway/services/parameters/drive_comparisons.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>

#include "gateway/core/text.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/parameters/memory_file.hpp"
#include "gateway/services/parameters/parameter_writes.hpp"

namespace axisgate {
namespace json = boost::json;

/// The drive of an axis in the site in force.
struct ComparedDrive {
    const DriveSpec* spec = nullptr;
    DriveId id = no_drive;
    LineId line = no_line;
};

namespace {
using Refused = ServiceRefusal::Why;

const std::string comparison_kind = "comparison";

ComparedDrive drive_of(const AxisPlace& axis) {
    ComparedDrive out;
    const Site& site = axis.site->site;
    for (std::size_t i = 0; i < site.drives.size() && i < axis.site->drive_ids.size(); ++i)
        if (site.drives[i].name == axis.spec().drive) out.spec = &site.drives[i], out.id = axis.site->drive_ids[i];
    for (std::size_t i = 0; i < site.lines.size() && i < axis.site->line_ids.size(); ++i)
        if (site.lines[i].name == axis.line) out.line = axis.site->line_ids[i];
    return out;
}

std::string text_member(const json::object& o, std::string_view member) {
    const auto* v = o.if_contains(member);
    return v && v->is_string() ? std::string(v->get_string()) : std::string();
}
}  // namespace

struct DriveComparisons::Run {
    AxisPlace axis;
    ComparedDrive drive;
    Origin origin;
    std::uint64_t since = 0;  ///< of the line's trace
    DriveComparisonInput input;
    DriveComparison result;
    std::function<void(Refusable<json::object>)> then;
};

void DriveComparisons::note(std::string text, const std::string& axis, const Origin& origin) const {
    Event e;
    e.kind = comparison_kind;
    e.axis = axis;
    e.text = std::move(text);
    e.who = origin.who ? *origin.who : "";
    e.door = std::string(name_of(origin.door));
    ports_.get<EventPort>().note(std::move(e));
}

void DriveComparisons::compare(const std::string& axis, const Origin& origin, std::function<void(Refusable<json::object>)> then) const {
    const auto place = find_axis(ports_.get<SitePort>(), axis);
    if (!place) return then(no_such("axis", axis));
    const ComparedDrive drive = drive_of(*place);
    if (!drive.spec || !place->catalogue) return then(ServiceRefusal{Refused::conflict, fmt::format("axis {} has no drive", axis), axis});
    const DriveStatus status = ports_.get<DrivePort>().drive_status(drive.id);
    if (status.simulated)
        return then(ServiceRefusal{
            Refused::conflict, fmt::format("drive {} is simulated now: there is no real drive to compare with its twin", drive.spec->name),
            axis});
    if (!status.device_online)
        return then(ServiceRefusal{Refused::no_answer, fmt::format("drive {} does not answer: {}", drive.spec->name, status.text), axis});
    auto run = std::make_shared<Run>(
        Run{*place,
            drive,
            origin,
            0,
            {{ports_.get<SitePort>().families(), place->site->site, axis}, {}, sweep_plan(*place->catalogue), {}, status.text, {}},
            {},
            std::move(then)});
    constexpr std::size_t all = 1'000'000;
    run->since = ports_.get<LinePort>().trace(drive.line, 1, all).next;
    const bool started = start_sweep(jobs_, ports_.get<AxisPort>(), axis, place->id(), run->input.plan.points, origin,
                                     [self = *this, run](Sweep sweep) { self.swept(run, std::move(sweep)); });
    if (!started) run->then(job_busy(axis));
}

void DriveComparisons::swept(const std::shared_ptr<Run>& run, Sweep sweep) const {
    const std::string axis = run->axis.spec().name;
    if (!find_axis(ports_.get<SitePort>(), axis)) return run->then(no_such("axis", axis));
    run->input.sweep = std::move(sweep);
    run->input.frames = seen_frames(ports_.get<LinePort>().trace(run->drive.line, run->since, ComparisonInput::most_frames).entries);
    ports_.get<RehearsalPort>().aside(
        run->axis.site, run->drive.spec->name,
        [run](const NonVolatile& memory) {
            run->input.memory = memory;
            run->result = compare_drive(run->input);
        },
        [self = *this, run] { self.compared(run); });
}

void DriveComparisons::compared(const std::shared_ptr<Run>& run) const {
    const DriveComparison& c = run->result;
    json::object report = document_of(c);
    report["at"] = format_time(ports_.get<ClockPort>().now_unix_ns());
    report["who"] = run->origin.who ? *run->origin.who : "";
    if (!c.fault.empty()) return run->then(std::move(report));
    json::object kept = report;
    kept["memory"] = memories_to_json({{c.drive, c.adoption.memory}});
    Document document{c.axis, json::serialize(kept), text_member(report, "who"), ports_.get<ClockPort>().now_unix_ns()};
    DocumentPort& documents = ports_.get<DocumentPort>();
    for (const Document& d : documents.documents(comparison_kind))  // of axes that are gone
        if (!find_axis(ports_.get<SitePort>(), d.name)) documents.delete_document(comparison_kind, d.name, [](const std::string&) {});
    documents.save_document(comparison_kind, std::move(document),
                            [self = *this, run, report = std::move(report)](const std::string& fault) {
                                if (!fault.empty()) return run->then(ServiceRefusal{Refused::not_stored, fault});
                                self.note(fmt::format("drive {} was compared with its twin: {} values read, {} differences",
                                                      run->result.drive, run->result.read, run->result.differences()),
                                          run->result.axis, run->origin);
                                run->then(report);
                            });
}

Refusable<json::object> DriveComparisons::report(const std::string& axis) const {
    if (!find_axis(ports_.get<SitePort>(), axis)) return no_such("axis", axis);
    const auto document = ports_.get<DocumentPort>().document(comparison_kind, axis);
    boost::system::error_code ec;
    auto parsed = document ? json::parse(document->text, ec) : json::value();
    if (!document || ec || !parsed.is_object()) return no_such("comparison of axis", axis);
    auto report = std::move(parsed.get_object());
    report.erase("memory");
    return report;
}

void DriveComparisons::adopt(const std::string& axis, const Origin& origin, std::function<void(Refusable<json::object>)> then) const {
    auto shown = report(axis);
    if (std::holds_alternative<ServiceRefusal>(shown)) return then(std::move(shown));
    const auto place = find_axis(ports_.get<SitePort>(), axis);
    const ComparedDrive drive = drive_of(*place);
    auto& o = std::get<json::object>(shown);
    if (!drive.spec || drive.spec->name != text_member(o, "drive") || drive.spec->address != text_member(o, "address") ||
        place->family != text_member(o, "family"))
        return then(ServiceRefusal{Refused::conflict,
                                   fmt::format("axis {} has another drive than the one that was compared: compare it first", axis), axis});
    const auto document = ports_.get<DocumentPort>().document(comparison_kind, axis);
    const auto kept = json::parse(document->text);
    std::map<std::string, NonVolatile> memories;
    std::string fault = memories_from_json(text_member(kept.get_object(), "memory"), memories);
    if (!fault.empty()) return then(ServiceRefusal{Refused::conflict, fault, axis});
    ports_.get<DrivePort>().adopt(drive.id, std::move(memories[drive.spec->name]), origin,
                                  [then = std::move(then), adoption = o["adoption"], axis](const std::string& why) {
                                      if (!why.empty()) return then(ServiceRefusal{Refused::conflict, why, axis});
                                      then(adoption.is_object() ? adoption.get_object() : json::object());
                                  });
}

}  // namespace axisgate
