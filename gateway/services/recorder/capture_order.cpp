// Reads a request as far as possible, so that all faults are reported together.
#include "gateway/services/recorder/capture_order.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "gateway/core/text.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/recorder/axr.hpp"
#include "gateway/services/recorder/channels.hpp"
#include "gateway/site/document_fields.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
/// A value of an axis in increments; empty with a fault if it is beyond the range of an axis.
std::optional<std::int64_t> increments(DocumentFields& f, std::string_view key, double value, double scale) {
    const double scaled = value * scale;
    if (std::isfinite(scaled) && std::fabs(scaled) < 9e15) return std::llround(scaled);
    f.fault(key, "this is further than an axis can go", "write a smaller value");
    return std::nullopt;
}

void read_trigger(const json::value& v, CaptureOrder& order, std::vector<SiteFault>& faults) {
    using Kind = CaptureTrigger::Kind;
    DocumentFields f(v, "/trigger", faults);
    CaptureTrigger& t = order.wish.trigger;
    const std::string kind = f.text("kind", true, "level");
    std::string axis = f.text("axis", false, "feeder"), edge = f.text("edge", false, "rising"), point = f.text("point", false, "position"),
                state = f.text("state", false, "moving");
    const auto level = f.number("level", "12.5");
    if (axis.empty() && !order.axes.empty()) axis = order.axes.front().name;
    double scale = 1;
    if (const auto i = index_of_name(order.axes, axis)) {
        t.axis = order.wish.axes[*i];
        scale = order.axes[*i].scale;
    } else if (!order.axes.empty()) {
        f.fault("axis", fmt::format("{} is none of the axes that are captured", axis), "name one of them");
    }
    if (!edge.empty() && edge != "rising" && edge != "falling") f.fault("edge", "an edge is rising or falling", "write one of them");
    t.rising = edge != "falling";
    if (kind == "at_once") {
        t.kind = Kind::at_once;
    } else if (kind == "command") {
        t.kind = Kind::command;
    } else if (kind == "level") {
        t.kind = Kind::level;
        const auto p = capture_point_named(point.empty() ? "position" : point);
        if (!p) f.fault("point", fmt::format("{} is no point", point), "write " + listed_points(level_points, " or "));
        t.point = p.value_or(CapturePoint::position);
        if (!level) f.fault("level", "a trigger of the kind level needs one", "write \"level\": 12.5, in units of its axis");
        t.level = level ? increments(f, "level", *level, scale).value_or(0) : 0;
    } else if (kind == "state") {
        t.kind = Kind::state;
        t.state = capture_state_named(state);
        if (t.state == 0) f.fault("state", fmt::format("\"{}\" is no state", state), "write one of " + capture_state_names());
    } else if (!kind.empty()) {
        f.fault("kind", fmt::format("{} is no trigger", kind), "write at_once, level, state or command");
    }
    f.unknown_keys();
}

void read_axes(const json::value* v, CaptureOrder& order, DocumentFields& f, const SiteState& site) {
    if (!v || !v->is_array() || v->get_array().empty() || v->get_array().size() > CaptureWish::most_axes)
        return f.fault("axes", fmt::format("axes is a list of 1 to {} names", CaptureWish::most_axes), "write \"axes\": [\"feeder\"]");
    for (std::size_t k = 0; k < v->get_array().size(); ++k) {
        const auto& x = v->get_array()[k];
        const std::string at = fmt::format("axes/{}", k);
        const auto i = x.is_string() ? index_of_name(site.site.axes, std::string(x.get_string())) : std::nullopt;
        if (!i || *i >= site.axis_ids.size()) {
            f.fault(at, "there is no such axis", "write the name of an axis");
            continue;
        }
        const AxisSpec& spec = site.site.axes[*i];
        const auto drive = index_of_name(site.site.drives, spec.drive);
        const std::string line = drive ? site.site.drives[*drive].line : std::string();
        if (order.line.empty()) order.line = line;
        if (line != order.line)
            f.fault(at, fmt::format("{} is on line {}, not on {}", spec.name, line, order.line), "capture axes of one line");
        if (index_of_name(order.axes, spec.name)) f.fault(at, fmt::format("{} stands there twice", spec.name), "name it once");
        order.axes.push_back({spec.name, spec.unit, spec.increments_per_unit});
        order.wish.axes.push_back(site.axis_ids[*i]);
    }
}
}  // namespace

CaptureOrder read_capture_order(const json::value& body, const SiteState& site, std::vector<SiteFault>& faults) {
    CaptureOrder o;
    DocumentFields f(body, "", faults);
    o.name = f.text("name", true, "before-tuning");
    if (const auto wrong = check_recording_name(o.name); !o.name.empty() && !wrong.empty()) f.fault("name", wrong, "choose another name");
    read_axes(f.get("axes"), o, f, site);
    const auto ms = [&](std::string_view key, std::int64_t low, std::int64_t high, std::int64_t otherwise) {
        return std::chrono::milliseconds(f.integer(key, low, high).value_or(otherwise));
    };
    const auto most_ms = std::chrono::duration_cast<std::chrono::milliseconds>(CaptureWish::longest).count();
    o.wish.period = Duration(std::chrono::seconds(1)) / f.integer("rate_hz", 1, 1000).value_or(1000);
    o.wish.before = ms("before_ms", 0, most_ms, 200);
    o.wish.after = ms("after_ms", 1, most_ms, 1000);
    o.wish.wait = ms("wait_ms", 100, std::chrono::duration_cast<std::chrono::milliseconds>(CaptureWish::longest_wait).count(), 60'000);
    if (const auto* t = f.get("trigger"); t && !o.axes.empty()) read_trigger(*t, o, faults);
    if (o.wish.before + o.wish.after > CaptureWish::longest)
        f.fault("after_ms", fmt::format("before_ms and after_ms are {} ms together at most", most_ms), "capture less");
    if (o.wish.rows() > Capture::most_rows)
        f.fault("after_ms", fmt::format("this would be {} rows of {}", o.wish.rows(), Capture::most_rows),
                "capture a shorter time, fewer axes or at a smaller rate");
    f.unknown_keys();
    return o;
}

std::string read_capture_name(const json::value& body, std::vector<SiteFault>& faults) {
    DocumentFields f(body, "", faults);
    std::string to = f.text("name", true, "after-tuning");
    if (const auto fault = check_recording_name(to); !to.empty() && !fault.empty()) f.fault("name", fault, "choose another name");
    f.unknown_keys();
    return to;
}

json::object capture_document(const CaptureInfo& i) {
    json::object o = i.summary;
    o["name"] = i.name;
    if (i.summary.empty()) {
        // A file that is not usable has no properties.
        for (const auto key : {"why", "who", "armed_at", "triggered_at", "trigger", "wanted_hz", "before_ms", "after_ms", "wait_ms"})
            o[key] = nullptr;
        o["state"] = "done";
        o["axes"] = json::array();
    }
    o["bytes"] = i.bytes;
    o["fault"] = text_or_null(i.fault);
    return o;
}

}  // namespace axisgate
