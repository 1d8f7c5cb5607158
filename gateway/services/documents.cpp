// The members are those of schema/openapi.yaml; a test compares both. Values that a drive never reported are null, not 0.
#include "gateway/services/documents.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "gateway/axis/cia402.hpp"
#include "gateway/core/parameter_form.hpp"
#include "gateway/core/text.hpp"
#include "gateway/services/specimens.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {

constexpr std::array<std::string_view, 2> drive_live_members{"axes", "status"};
constexpr std::array<std::string_view, 2> line_live_members{"drives", "status"};

json::object status_document(const LineStatus& s) {
    return {{"state", name_of(s.state)}, {"text", s.text},           {"frames_in", s.frames_in}, {"frames_out", s.frames_out},
            {"bytes_in", s.bytes_in},    {"bytes_out", s.bytes_out}, {"dropped", s.dropped},     {"errors", s.errors},
            {"reopened", s.reopened},    {"queued", s.queued},       {"load", number(s.load)},   {"tx_errors", s.tx_errors},
            {"rx_errors", s.rx_errors}};
}

json::value bound(const std::optional<double>& v) { return v ? number(*v) : json::value(nullptr); }
}  // namespace

std::string_view name_of(Quality quality) noexcept {
    switch (quality) {
        case Quality::unknown:
            return "unknown";
        case Quality::good:
            return "good";
        case Quality::stale:
            return "stale";
    }
    return "unknown";
}

std::string_view name_of(Access access) noexcept {
    switch (access) {
        case Access::read:
            return "R";
        case Access::write:
            return "W";
        case Access::read_write:
            return "RW";
    }
    return "R";
}

json::value to_json(const Value& value) {
    if (const auto* b = std::get_if<bool>(&value)) return *b;
    if (const auto* i = std::get_if<std::int64_t>(&value)) return *i;
    if (const auto* d = std::get_if<double>(&value)) return number(*d);
    if (const auto* s = std::get_if<std::string>(&value)) return json::value(*s);
    return nullptr;
}

namespace {
json::value json_of(const PointValue& value) {
    if (const auto* b = std::get_if<bool>(&value)) return *b;
    if (const auto* i = std::get_if<std::int64_t>(&value)) return *i;
    if (const auto* d = std::get_if<double>(&value)) return number(*d);
    if (const auto* s = std::get_if<std::string_view>(&value)) return json::value(*s);
    return nullptr;
}

/// The client whose stop holds the axis, and what moves the axis again; null if there is none.
json::value stop_latch_text(const AxisPicture& p) {
    constexpr std::uint16_t latched = 1u << 0, by_client = 1u << 2, by_safe_input = 1u << 3;  // register 23
    constexpr std::string_view fresh =
        "it moves again by a new command, or when a controller changes its own words (a new set-point, the halt bit or the enable bits)";
    if (!(p.stop_latch & latched)) return nullptr;
    if (p.stop_latch & by_safe_input)
        return "a safe input has taken power or motion away: give the input back, then enable the axis; a controller takes its enable bits "
               "back first";
    std::string by = "the gateway";
    if (p.stop_latch & by_client)
        by = p.stop_latch_by[0] != 0 ? p.stop_latch_by.data() : "another client";
    else if (p.fail_safe_cause != 0)
        by += fmt::format(" ({})", name_of(static_cast<LossCause>(p.fail_safe_cause)));
    return json::value(fmt::format("{} has stopped it: {}", by, fresh));
}

json::value modes_of(const AxisView& v) {
    json::array modes;
    if (v.catalogue) {
        for (const std::int16_t mode : v.catalogue->modes())
            modes.emplace_back(mode);
    }
    return modes;
}

json::value set_points_of(const AxisView& v) {
    const AxisPicture& p = v.picture;
    return json::object{{"streaming", p.streaming},
                        {"mode", p.streaming ? json::value(name_of(p.stream_mode)) : json::value(nullptr)},
                        {"taken", p.set_points},
                        {"refused", p.set_points_refused},
                        {"reason", p.set_point_refusal == Reason::none ? json::value(nullptr) : json::value(name_of(p.set_point_refusal))}};
}

json::value error_of(const AxisView& v) {
    const AxisPicture& p = v.picture;
    std::string text;
    if (p.error_code != 0) {
        const ErrorCode* e = v.catalogue ? v.catalogue->error(p.error_code) : nullptr;
        text = !e ? "not in the catalogue" : !e->text.empty() ? e->text : e->name;
    }
    return json::object{{"code", p.error_code}, {"text", text}};
}

json::value authority_until(const AxisView& v) {
    const AxisPicture& p = v.picture;
    return p.authority_holder[0] != 0 ? json::value(format_time(v.at_unix_ns + ns_of(p.authority_until) - ns_of(p.at)))
                                      : json::value(nullptr);
}

json::value age_of(const AxisView& v) {
    if (!v.picture.ever_seen || !v.now_unix_ns) return nullptr;
    return std::max<std::int64_t>(0, (*v.now_unix_ns - v.at_unix_ns) / 1'000'000);
}

/// Rows that need more than their value in the picture.
struct Composed {
    std::string_view name;
    json::value (*make)(const AxisView&);
};
constexpr auto composed = std::to_array<Composed>({
    {"line", [](const AxisView& v) { return json::value(v.line); }},
    {"family", [](const AxisView& v) { return json::value(v.family); }},
    {"modes", modes_of},
    {"set_points", set_points_of},
    {"stop_latch_text", [](const AxisView& v) { return stop_latch_text(v.picture); }},
    {"error", error_of},
    {"authority_until", authority_until},
    {"at", [](const AxisView& v) { return v.picture.ever_seen ? json::value(format_time(v.at_unix_ns)) : json::value(nullptr); }},
    {"age_ms", age_of},
    {"number", [](const AxisView& v) { return json::value(v.spec.number); }},  // from the site, because there may be no picture yet
});
static_assert(std::ranges::all_of(axis_point_table,
                                  [](const AxisPointRow& row) {
                                      return row.document != PointInDocument::composed ||
                                             std::ranges::find(composed, row.name, &Composed::name) != composed.end();
                                  }),
              "what the table calls composed is made here");

/// The document's value of one row; null while it is unknown.
json::value axis_member(const AxisView& v, const AxisPointRow& row) {
    const auto c = std::ranges::find(composed, row.name, &Composed::name);
    return c != composed.end() ? c->make(v) : json_of(said(row, v.picture, v.spec.increments_per_unit));
}
}  // namespace

json::object axis_document(const AxisView& v, AxisPointRows rows) {
    json::object o = to_json(v.spec);
    for (const auto& row : rows) {
        if (row.document == PointInDocument::no || (row.name == "age_ms" && !v.now_unix_ns)) continue;
        o[row.name] = axis_member(v, row);
    }
    return o;
}

static json::value sync_document(const DriveBeats& b) {
    if (b.turns == 0) return nullptr;
    return json::object{{"beat_ms", milliseconds_of(b.beat)}, {"turns", b.turns}, {"cycle_ms", milliseconds_of(b.beat * b.turns)}};
}

json::object drive_document(const SiteState& site, std::size_t index, const DriveStatus& status) {
    const DriveSpec& d = site.site.drives[index];
    json::object o = to_json(d);
    o["family"] = site.site.family_of(d);
    json::array axes;
    for (const auto& a : site.site.axes) {
        if (a.drive == d.name) axes.emplace_back(a.name);
    }
    o["axes"] = std::move(axes);
    o["status"] = json::object{{"presence", name_of(status.presence)},
                               {"online", status.presence != Presence::offline},
                               {"simulated", status.simulated},
                               {"device_online", status.device_online},
                               {"text", status.text},
                               {"silent_exchanges", status.silent_exchanges},
                               {"retry_pause_ms", status.retry_pause_ms},
                               {"sync", sync_document(status.beats)}};
    return o;
}

static json::object counters_document(const AdapterCounters& c) {
    return {{"exchanges", c.exchanges}, {"timeouts", c.timeouts}, {"retries", c.retries},
            {"refused", c.refused},     {"garbled", c.garbled},   {"unexpected", c.unexpected}};
}

json::object line_document(const SiteState& site, std::size_t index, const LineReport& report) {
    const LineSpec& l = site.site.lines[index];
    json::object o = to_json(l);
    json::array drives;
    for (const auto& d : site.site.drives) {
        if (d.line == l.name) drives.emplace_back(d.name);
    }
    o["drives"] = std::move(drives);
    json::object s = status_document(report.status);
    const AdapterCounters& c = report.counters;
    s["counters"] = counters_document(c);
    s["scan_counters"] = counters_document(report.scanned);
    json::array families;
    for (const auto& f : report.families)
        families.push_back(json::object{{"family", f.family}, {"counters", counters_document(f.counters)}});
    s["families"] = std::move(families);
    s["unclaimed"] = report.unclaimed;
    s["has_twin_bus"] = report.has_twin_bus;
    s["twin"] = report.has_twin_bus ? json::value(status_document(report.twin_status)) : json::value(nullptr);
    o["status"] = std::move(s);
    return o;
}

json::object event_document(const Event& e) {
    return {{"id", e.id},
            {"at", format_time(e.at_unix_ns)},
            {"severity", name_of(e.severity)},
            {"kind", e.kind},
            {"axis", text_or_null(e.axis)},
            {"drive", text_or_null(e.drive)},
            {"line", text_or_null(e.line)},
            {"code", e.code == 0 ? json::value(nullptr) : json::value(e.code)},
            {"text", e.text},
            {"who", text_or_null(e.who)},
            {"door", text_or_null(e.door)},
            {"parameter", text_or_null(e.parameter)},
            {"old", text_or_null(e.old_value)},
            {"new", text_or_null(e.new_value)}};
}

json::object frame_document(const TraceEntry& e, const std::vector<std::string>& decoded) {
    const Frame& f = e.frame;
    const bool bytes = f.kind == Frame::Kind::bytes;
    return {{"sequence", e.sequence},
            {"at", format_time(e.at_unix_ns)},
            {"to_drive", e.to_drive},
            {"simulated", e.simulated},
            {"kind", bytes                        ? "bytes"
                     : f.kind == Frame::Kind::can ? "can"
                                                  : "can_error"},
            {"id", bytes ? json::value(nullptr) : json::value(f.id)},
            {"extended", f.extended},
            {"remote", f.remote},
            {"data", to_hex(f.data())},
            {"text", to_text(f)},
            {"decoded", json::array(decoded.begin(), decoded.end())}};
}

namespace {
json::value allowed_document(const std::vector<std::pair<std::int64_t, std::string>>& allowed) {
    if (allowed.empty()) return nullptr;
    json::array list;
    for (const auto& [value, meaning] : allowed)
        list.push_back(json::object{{"value", value}, {"meaning", meaning}});
    return list;
}

/// The meaning of the number: its bit fields, ranges of values, and its form while another parameter has a certain value.
void put_forms(json::object& o, const Catalogue& catalogue, Point point) {
    json::array fields, meanings;
    for (const auto& f : fields_of(catalogue, point))
        fields.push_back(
            json::object{{"name", f.name}, {"low_bit", f.low_bit}, {"bits", f.bits}, {"allowed", allowed_document(f.allowed)}});
    for (const auto& m : meanings_of(catalogue, point))
        meanings.push_back(json::object{{"from", m.from}, {"through", m.through}, {"meaning", m.text}});
    o["fields"] = fields.empty() ? json::value(nullptr) : json::value(std::move(fields));
    o["meanings"] = meanings.empty() ? json::value(nullptr) : json::value(std::move(meanings));
    o["alternate"] = nullptr;
    if (const auto a = alternate_of(catalogue, point)) {
        o["alternate"] = json::object{{"parameter", a->of ? json::value(catalogue.id_of(*a->of)) : json::value(nullptr)},
                                      {"equals", a->of ? json::value(a->equals) : json::value(nullptr)},
                                      {"unit", text_or_null(a->unit)},
                                      {"min", bound(a->min)},
                                      {"max", bound(a->max)}};
    }
}
}  // namespace

json::object parameter_document(const Catalogue& catalogue, Point point, std::string_view id) {
    const Parameter& p = *catalogue.parameter(point);
    const auto selector = catalogue.selector(point);
    json::object o{{"id", id},
                   {"name", p.name},
                   {"group", p.group},
                   {"type", name_of(p.type)},
                   {"unit", text_or_null(p.unit)},
                   {"min", bound(p.min)},
                   {"max", bound(p.max)},
                   {"default", to_json(p.factory_default)},
                   {"access", name_of(p.access)},
                   {"storage", text_or_null(p.storage)},
                   {"addressing", p.addressing},
                   {"live", p.live},
                   {"description", p.description}};
    o["allowed"] = allowed_document(p.allowed);
    put_forms(o, catalogue, point);
    const auto* choice = entry_of(catalogue, point)->if_contains("choice");
    o["choice"] = choice && choice->is_array() ? *choice : json::value(json::array());
    o["first"] = p.count == 0 ? json::value(nullptr) : json::value(p.first);
    o["count"] = p.count == 0 ? json::value(nullptr) : json::value(p.count);
    o["selector"] = selector ? json::value(*selector) : json::value(nullptr);
    return o;
}

json::object command_document(const Catalogue& catalogue, const CatalogueCommand& c) {
    json::value confirm;
    for (const auto& v : catalogue.document().at("commands").as_array()) {
        const auto* o = v.if_object();
        const auto* id = o ? o->if_contains("id") : nullptr;
        const auto* ask = id && *id == json::value(c.id) ? o->if_contains("confirm") : nullptr;
        if (ask) confirm = *ask;
    }
    const auto or_null = [](const std::optional<double>& d) { return d ? json::value(*d) : json::value(nullptr); };
    json::array arguments;
    for (const auto& a : c.arguments) {
        arguments.push_back({{"name", a.name},
                             {"type", name_of(a.type)},
                             {"unit", text_or_null(a.unit)},
                             {"scale", a.scale},
                             {"min", or_null(a.min)},
                             {"max", or_null(a.max)},
                             {"default", to_json(a.fallback)},
                             {"description", text_or_null(a.description)}});
    }
    return {{"id", c.id},
            {"name", c.name},
            {"description", text_or_null(c.description)},
            {"completes", name_of(c.completes)},
            {"confirm", std::move(confirm)},
            {"arguments", std::move(arguments)}};
}

json::object error_document(const ErrorCode& e) {
    return {{"code", e.code},
            {"through", e.through == 0 ? json::value(nullptr) : json::value(e.through)},
            {"kind", text_or_null(e.kind)},
            {"name", text_or_null(e.name)},
            {"text", text_or_null(e.text)},
            {"cause", text_or_null(e.cause)},
            {"remedy", text_or_null(e.remedy)}};
}

json::object family_document(const FamilyEntry& entry) {
    const Family& f = *entry.family;
    json::object o{{"name", f.name}, {"number", entry.catalogue->number()}};
    for (const auto& [k, v] : entry.catalogue->document()) {
        if (k != "family" && k != "parameters" && k != "commands" && k != "errors" && !o.contains(k)) o[k] = v;
    }
    o["uses_can"] = f.uses_can;
    o["uses_bytes"] = f.uses_bytes;
    o["takes_description"] = f.takes_description;
    o["factory_address"] = f.factory_address;
    o["default_bit_rate"] = f.default_bit_rate == 0 ? json::value(nullptr) : json::value(f.default_bit_rate);
    o["default_format"] = text_or_null(f.default_format);
    o["parameters"] = entry.catalogue->parameters().size();
    o["commands"] = entry.catalogue->commands().size();
    o["errors"] = entry.catalogue->errors().size();
    o["freedoms"] = freedoms_document(*entry.catalogue);
    json::value& options = o["options"];  // every twin is a specimen; the page of the family does not repeat it
    if (!options.is_array()) options = json::array();
    options.get_array().push_back({{"name", "specimen"},
                                   {"of", json::array{"twin"}},
                                   {"default", "0"},
                                   {"description",
                                    "the drive of this family that the twin is: a seed from 0 (as its manual shows it) to "
                                    "1000000000, or slow, sparse, strict, chatty, weak, old"}});
    return o;
}

bool is_read_only_drive_member(std::string_view name) noexcept {
    return std::ranges::find(drive_live_members, name) != drive_live_members.end();
}
bool is_read_only_line_member(std::string_view name) noexcept {
    return std::ranges::find(line_live_members, name) != line_live_members.end();
}

json::object axis_parameter_document(const Catalogue& catalogue, Point point, std::string_view id, const LiveParameter& live,
                                     const StoredParameter* stored, std::string_view text) {
    json::object o = parameter_document(catalogue, point, id);
    o["value"] = to_json(live.value);
    o["quality"] = name_of(known(live.value) ? live.quality : Quality::unknown);
    o["at"] = known(live.value) ? json::value(format_time(live.at_unix_ns)) : json::value(nullptr);
    o["stored"] = stored ? to_json(stored->value) : json::value(nullptr);
    o["previous"] = stored ? to_json(stored->previous) : json::value(nullptr);
    o["written_at"] = stored ? json::value(format_time(stored->at_unix_ns)) : json::value(nullptr);
    o["written_by"] = stored ? text_or_null(stored->who) : json::value(nullptr);
    o["written_through"] = stored ? text_or_null(stored->door) : json::value(nullptr);
    o["text"] = text;
    o["meaning"] = text_or_null(value_in_words(catalogue, point, live.value));
    return o;
}

}  // namespace axisgate
