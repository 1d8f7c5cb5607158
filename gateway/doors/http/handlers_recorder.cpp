// Handlers of the recorder: trends of axes as JSON or CSV; recordings made, listed, downloaded, renamed, deleted. The disk is not waited
// for.
#include <fmt/format.h>

#include <algorithm>
#include <boost/json/array.hpp>
#include <utility>

#include "gateway/core/text.hpp"
#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/services/recipes/recipe_record.hpp"
#include "gateway/services/recorder/axr.hpp"
#include "gateway/services/recorder/recording_document.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
constexpr std::int64_t most_columns = 5000;
constexpr std::size_t most_trend_axes = 64;

std::vector<std::string> comma_list(std::string_view text) {
    std::vector<std::string> out;
    while (!text.empty()) {
        const auto end = std::min(text.find(','), text.size());
        if (end > 0) out.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return out;
}

/// The requested axes, otherwise the first ones of all.
std::vector<std::string> asked_axes(Call& c, const SiteState& site) {
    std::vector<std::string> names = comma_list(c.target.query.get("axes").value_or(""));
    if (!names.empty()) return names;
    for (const auto& a : site.site.axes)
        if (names.size() < most_trend_axes) names.push_back(a.name);
    return names;
}

/// Two instants, ms since 1970; defaults: now, and a minute before the end.
std::pair<std::int64_t, std::int64_t> asked_stretch(Call& c, const ClockPort& clock, std::optional<Response>& fault) {
    constexpr std::int64_t ms_limit = INT64_MAX / 1'000'000;
    const std::int64_t to = query_whole(c, "to", 0, ms_limit, clock.now_unix_ns() / 1'000'000, fault);
    return {query_whole(c, "from", 0, ms_limit, std::max<std::int64_t>(0, to - 60'000), fault), to};
}

const RecordingInfo* recording_in(const std::vector<RecordingInfo>& list, std::string_view name) {
    const auto it = std::ranges::find(list, name, &RecordingInfo::name);
    return it == list.end() ? nullptr : &*it;
}

/// The optional text members of a body.
std::vector<Fault> texts_of(const json::object& body, std::initializer_list<std::pair<std::string_view, std::string*>> into) {
    std::vector<Fault> faults;
    for (const auto& [key, value] : body) {
        const auto it = std::ranges::find(into, std::string_view(key), [](const auto& p) { return p.first; });
        if (it == into.end())
            faults.push_back({"/" + std::string(key), fmt::format("{} is not known here", std::string_view(key)), "leave it out"});
        else if (!value.is_string() || value.get_string().size() > 500)
            faults.push_back({"/" + std::string(key), fmt::format("{} must be a text of at most 500 bytes", std::string_view(key)),
                              "write it in quotes"});
        else
            *it->second = std::string(value.get_string());
    }
    return faults;
}
}  // namespace

Response kept_refusal(std::string_view kind, const RecordingFault& fault, std::string_view name) {
    using Kind = RecordingFault::Kind;
    switch (fault.kind) {
        case Kind::no_such:
            return nothing_named(kind, name);
        case Kind::exists:
        case Kind::damaged:
            return problem(409, "conflict", fault.text);
        case Kind::busy:
            return problem(503, "busy", fault.text);
        default:
            return problem(507, "not_stored", fault.text);
    }
}

Handled get_trends(Call& c, const ClockPort& clock, RecorderPort& recorder, const SitePort& sites) {
    const auto site = sites.site();
    const std::vector<std::string> names = asked_axes(c, *site);
    if (names.size() > most_trend_axes) return bad_query("axes", fmt::format("at most {} axes", most_trend_axes));
    std::vector<std::string> points = comma_list(c.target.query.get("points").value_or(""));
    if (points.empty()) points.assign(trend_points.begin(), trend_points.end());
    for (const auto& p : points) {
        if (std::ranges::find(trend_points, p) == trend_points.end()) return bad_query("points", "some of " + listed_points(trend_points));
    }
    std::optional<Response> fault;
    const auto [from, to] = asked_stretch(c, clock, fault);
    const std::int64_t columns = query_whole(c, "columns", 1, most_columns, 1000, fault);
    if (fault) return *fault;
    static constexpr std::string_view media[] = {"application/json", "text/csv"};
    const auto liked = best_accepted(c.request.headers.get("Accept"), media);
    if (!liked) return problem(406, "not_acceptable", "this is application/json or text/csv");
    const std::int64_t offset = clock.to_unix_ns(at_ns(0));
    const auto found = trends_of(recorder, clock, *site, names, {from, to}, static_cast<std::size_t>(columns));
    if (const auto* refusal = std::get_if<ServiceRefusal>(&found)) return problem_of(*refusal);
    const auto& axes = std::get<std::vector<TrendAxis>>(found);
    if (*liked == 1) {
        Response r = file_answer("text/csv; charset=utf-8", "trends.csv", trend_csv(axes, points, offset));
        r.headers.set("Vary", "Accept");
        return r;
    }
    json::array list;
    for (const auto& a : axes)
        list.push_back(trend_document(a, points, offset));
    Response r = json_response(json::object{{"from", from}, {"to", to}, {"axes", std::move(list)}});
    r.headers.set("Vary", "Accept");
    return r;
}

Handled get_recorded_steps(Call& c, const ClockPort& clock, RecorderPort& recorder, const SitePort& sites) {
    const auto site = sites.site();
    const std::vector<std::string> names = asked_axes(c, *site);
    if (names.size() > most_trend_axes) return bad_query("axes", fmt::format("at most {} axes", most_trend_axes));
    std::optional<Response> fault;
    const auto [from, to] = asked_stretch(c, clock, fault);
    if (fault) return *fault;
    std::vector<AxisPlace> places;
    for (const auto& name : names) {
        auto place = find_axis(sites, name);
        if (!place) return nothing_named("axis", name);
        places.push_back(std::move(*place));
    }
    const std::int64_t offset = clock.to_unix_ns(at_ns(0));
    const Instant begin = at_ns(saturated_difference(from * 1'000'000, offset));
    // The last millisecond of `to` is included completely.
    const Instant end = at_ns(saturated_difference(saturated_sum(to * 1'000'000, 999'999), offset));
    auto record = std::make_shared<RecipeRecord>(std::move(places), begin, end);
    const auto begins = recorder.recorder_state().from;
    recorder.read_stretch(
        begin, [record](const FlightRecord& r) { record->take(r); },
        [record, from = from, to = to, respond = c.respond,
         begins = begins ? json::value(format_time(clock.to_unix_ns(*begins))) : json::value(nullptr)] {
            json::object o{{"from", from}, {"to", to}, {"begins", begins}};
            for (auto& [key, value] : record->document())
                o[key] = std::move(value);
            respond(json_response(std::move(o)));
        });
    return {gateway_limit, problem(504, "no_answer", "the recorder has not answered")};
}

Handled list_recordings(Call&, const ClockPort& clock, RecorderPort& recorder) { return json_response(recorder_document(recorder, clock)); }

Handled make_recording(Call& c, EventPort& events, RecorderPort& recorder) {
    std::string name, why;
    auto faults = texts_of(c.body.get_object(), {{"name", &name}, {"why", &why}});
    if (const auto wrong = check_recording_name(name); faults.empty() && !wrong.empty())
        faults.push_back({"/name", wrong, "name the recording"});
    if (!faults.empty()) return invalid(std::move(faults));
    recorder.freeze(name, why, c.who(),
                    [name, who = c.who(), &events, respond = c.respond](const RecordingFault& fault, const RecordingInfo& info) {
                        if (fault.kind != RecordingFault::Kind::none) return respond(kept_refusal("recording", fault, name));
                        Event e;
                        e.kind = "recording";
                        e.text = fmt::format("recording {} was made, {} bytes", name, info.bytes);
                        e.who = who;
                        e.door = std::string(axisgate::name_of(clients));
                        events.note(std::move(e));
                        Response r = json_response(recording_document(info), 201);
                        r.headers.set("Location", "/api/v1/recorder/recordings/" + percent_encode(name));
                        respond(std::move(r));
                    });
    return {gateway_limit, problem(504, "no_answer", "the disk has not answered")};
}

Handled get_recording(Call& c, RecorderPort& recorder) {
    const auto list = recorder.recordings();
    const auto* info = recording_in(list, c.names[0]);
    if (!info) return nothing_named("recording", c.names[0]);
    static constexpr std::string_view media[] = {"application/vnd.axisgate.axr", "application/json"};
    const auto liked = best_accepted(c.request.headers.get("Accept"), media);
    if (!liked) return problem(406, "not_acceptable", "this is application/vnd.axisgate.axr or application/json");
    if (*liked == 1) {
        Response r = json_response(recording_document(*info));
        r.headers.set("Vary", "Accept");
        return r;
    }
    recorder.load_recording(c.names[0], [name = c.names[0], respond = c.respond](std::optional<std::string> bytes) {
        if (!bytes) return respond(nothing_named("recording", name));
        Response r = file_answer("application/vnd.axisgate.axr", name + ".axr", std::move(*bytes));
        r.headers.set("Vary", "Accept");
        respond(std::move(r));
    });
    return {gateway_limit, problem(504, "no_answer", "the disk has not answered")};
}

Handled play_back_recording(Call& c, RecorderPort& recorder) {
    std::optional<Response> fault;
    const std::int64_t at_ms = query_whole(c, "at", 0, INT64_MAX / 1'000'000, -1, fault);
    const std::int64_t frames = query_whole(c, "frames", 0, 500, 50, fault);
    const std::int64_t columns = query_whole(c, "columns", 0, most_columns, 0, fault);
    if (fault) return *fault;
    PlaybackWish wish;
    if (at_ms >= 0) wish.at_unix_ns = at_ms * 1'000'000;
    wish.frames = static_cast<std::size_t>(frames);
    wish.columns = static_cast<std::size_t>(columns);
    recorder.play_back(c.names[0], wish, [name = c.names[0], respond = c.respond](const RecordingFault& wrong, json::object document) {
        respond(wrong.kind == RecordingFault::Kind::none ? json_response(std::move(document)) : kept_refusal("recording", wrong, name));
    });
    return {gateway_limit, problem(504, "no_answer", "the disk has not answered")};
}

Handled rename_recording(Call& c, RecorderPort& recorder) {
    std::string to;
    auto faults = texts_of(c.body.get_object(), {{"name", &to}});
    if (const auto wrong = check_recording_name(to); faults.empty() && !wrong.empty())
        faults.push_back({"/name", wrong, "choose another name"});
    if (!faults.empty()) return invalid(std::move(faults));
    recorder.rename_recording(c.names[0], to, [name = c.names[0], to, &recorder, respond = c.respond](const RecordingFault& fault) {
        if (fault.kind != RecordingFault::Kind::none) return respond(kept_refusal("recording", fault, name));
        const auto list = recorder.recordings();
        const auto* info = recording_in(list, to);
        respond(info ? json_response(recording_document(*info)) : nothing_named("recording", to));
    });
    return {gateway_limit, problem(504, "no_answer", "the disk has not answered")};
}

Handled remove_recording(Call& c, RecorderPort& recorder) {
    recorder.remove_recording(c.names[0], [name = c.names[0], respond = c.respond](const RecordingFault& fault) {
        if (fault.kind != RecordingFault::Kind::none) return respond(kept_refusal("recording", fault, name));
        respond(nothing_left());
    });
    return {gateway_limit, problem(504, "no_answer", "the disk has not answered")};
}

}  // namespace axisgate::http
