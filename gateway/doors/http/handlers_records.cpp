// Handlers of recorded data: the frames of a line, and the events, as JSON or as files for other tools.
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/alarms/alarm_service.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/event_lists.hpp"
#include "gateway/services/frame_decoder.hpp"
#include "gateway/wire/frame_export.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
constexpr std::int64_t most_frames = 65536;
constexpr std::int64_t json_frames = 1000;

enum class Format : std::uint8_t { json, candump, pcapng, text };

/// By `?format=`, otherwise by Accept.
std::optional<Format> format_of(const Call& c, std::optional<Response>& fault) {
    if (const auto name = c.target.query.get("format")) {
        if (*name == "json") return Format::json;
        if (*name == "candump") return Format::candump;
        if (*name == "pcapng") return Format::pcapng;
        if (*name == "text") return Format::text;
        fault = bad_query("format", "json, candump, pcapng or text");
        return std::nullopt;
    }
    static constexpr std::array<std::string_view, 4> media{"application/json", "text/plain", "application/x-pcapng",
                                                           "application/vnd.tcpdump.pcap"};
    const auto best = best_accepted(c.request.headers.get("Accept"), media);
    if (!best) {
        fault = problem(406, "not_acceptable", "this can be given as application/json, text/plain (candump) or application/x-pcapng");
        return std::nullopt;
    }
    static constexpr std::array<Format, 4> formats{Format::json, Format::candump, Format::pcapng, Format::pcapng};
    return formats[*best];
}

/// One answer to a request for frames, made in pieces, because thousands of frames take longer than a command should wait. Each piece reads
/// the oldest remaining frames; those that the line overwrites meanwhile are counted as missed.
class TraceWork {
public:
    /// `since` < 0: the newest `limit` frames.
    TraceWork(const Call& c, const LinePort& lines, LineId line, Format format, std::int64_t since, std::uint64_t limit,
              const SitePort& sites)
        : lines_(lines),
          line_(line),
          name_(c.names[0]),
          format_(format),
          newest_(since < 0),
          later_(c.context.later),
          respond_(c.respond),
          until_(lines.trace(line, INT64_MAX, 0).next),
          at_(newest_ ? until_ - std::min(limit, until_) : static_cast<std::uint64_t>(since)),
          left_(limit) {
        if (format == Format::json) decoder_.emplace(sites.families(), sites.site()->site, name_);
    }
    static void go_on(std::shared_ptr<TraceWork> work) {
        const auto later = work->later_;
        later([work = std::move(work)]() mutable {
            if (work->read_some()) return go_on(std::move(work));
            work->respond_(work->answer());
        });
    }

private:
    static constexpr std::uint64_t piece = 64, json_piece = 16;

    /// Returns false after the last piece.
    bool read_some() {
        const std::uint64_t most = std::min({decoder_ ? json_piece : piece, left_, until_ - std::min(at_, until_)});
        Trace t = lines_.trace(line_, at_, static_cast<std::size_t>(most));
        if (!newest_) missed_ += t.missed;
        left_ -= t.entries.size();
        const bool more = t.next > at_ && t.next < until_ && left_ > 0;
        at_ = t.next;
        put(t.entries);
        return more;
    }
    void put(const std::vector<TraceEntry>& entries) {
        if (entries.empty()) return;
        // A run of bytes has no candump form; the text form is the closest. A line has one kind of frames.
        if (format_ == Format::candump && entries.front().frame.kind == Frame::Kind::bytes) as_text_ = true;
        if (decoder_) {
            for (const auto& e : entries)
                frames_.push_back(frame_document(e, decoder_->read(e)));
        } else if (format_ == Format::pcapng) {
            capture_.add(entries);
        } else {
            text_ += format_ == Format::text || as_text_ ? trace_text(entries, name_) : candump_text(entries, name_);
        }
    }
    Response answer() {
        if (decoder_)
            return json_response(json::object{{"line", name_}, {"missed", missed_}, {"next", at_}, {"frames", std::move(frames_)}});
        if (format_ == Format::pcapng) return file_answer("application/x-pcapng", name_ + ".pcapng", capture_.take());
        return file_answer("text/plain; charset=utf-8", name_ + (format_ == Format::candump ? ".log" : ".txt"), std::move(text_));
    }

    const LinePort& lines_;
    LineId line_;
    std::string name_;
    Format format_;
    bool newest_, as_text_ = false;
    std::function<void(std::function<void()>)> later_;
    Respond respond_;
    std::uint64_t until_;  ///< later frames belong to the next request
    std::uint64_t at_, left_, missed_ = 0;
    std::optional<FrameDecoder> decoder_;  ///< of JSON
    json::array frames_;
    Pcapng capture_{name_};
    std::string text_;
};

enum class EventForm : std::uint8_t { json, csv, text };
std::optional<EventForm> event_form(const Call& c, std::optional<Response>& fault) {
    if (fault) return std::nullopt;
    static constexpr std::array forms{EventForm::json, EventForm::csv, EventForm::text};
    if (const auto name = c.target.query.get("format")) {
        static constexpr std::array<std::string_view, 3> names{"json", "csv", "text"};
        const auto it = std::ranges::find(names, *name);
        if (it != names.end()) return forms[static_cast<std::size_t>(it - names.begin())];
        fault = bad_query("format", "json, csv or text");
        return std::nullopt;
    }
    static constexpr std::array<std::string_view, 3> media{"application/json", "text/csv", "text/plain"};
    const auto best = best_accepted(c.request.headers.get("Accept"), media);
    if (best) return forms[*best];
    fault = problem(406, "not_acceptable", "this can be given as application/json, text/csv or text/plain");
    return std::nullopt;
}

Response events_answer(const std::vector<Event>& events, EventForm form) {
    if (form == EventForm::csv) return file_answer("text/csv; charset=utf-8", "events.csv", events_csv(events));
    if (form == EventForm::text) return file_answer("text/plain; charset=utf-8", "events.txt", events_text(events));
    json::array out;
    for (const auto& e : events)
        out.push_back(event_document(e));
    return json_response(out);
}
}  // namespace

Handled get_trace(Call& c, const LinePort& lines, const SitePort& sites) {
    const auto site = sites.site();
    const auto index = index_of_name(site->site.lines, c.names[0]);
    if (!index || *index >= site->line_ids.size()) return nothing_named("line", c.names[0]);
    std::optional<Response> fault;
    const auto format = format_of(c, fault);
    if (fault) return *fault;
    const std::int64_t since = query_whole(c, "since", 0, INT64_MAX, -1, fault);
    const std::int64_t limit = query_whole(c, "limit", 1, most_frames, *format == Format::json ? json_frames : most_frames, fault);
    if (fault) return *fault;

    auto work = std::make_shared<TraceWork>(c, lines, site->line_ids[*index], *format, since, static_cast<std::uint64_t>(limit), sites);
    TraceWork::go_on(std::move(work));
    return {gateway_limit, problem(504, "time_out", "the frames were not read in time: ask for fewer, with `limit`")};
}

Handled list_events(Call& c, EventPort& events) {
    EventQuery query;
    if (const auto since = c.target.query.get("since")) {
        if (const auto id = parse_whole(*since, 0, INT64_MAX)) {
            query.since_id = static_cast<std::uint64_t>(*id);
        } else if (const auto time = parse_time(*since)) {
            query.since_unix_ns = *time;
        } else {
            return bad_query("since", "an event id or a time such as 2026-01-02T03:04:05Z");
        }
    }
    if (const auto axis = c.target.query.get("axis")) query.axis = std::string(*axis);
    if (const auto severity = c.target.query.get("severity")) {
        for (const auto s : {Severity::info, Severity::warning, Severity::alarm}) {
            if (*severity == name_of(s)) query.at_least = s;
        }
        if (!query.at_least) return bad_query("severity", "info, warning or alarm");
    }
    if (const auto kind = c.target.query.get("kind")) query.kind = std::string(*kind);
    std::optional<Response> fault;
    query.before_id = static_cast<std::uint64_t>(query_whole(c, "before", 1, INT64_MAX, 0, fault));
    query.limit = static_cast<std::size_t>(query_whole(c, "limit", 1, 1000, 200, fault));
    if (const auto order = c.target.query.get("order")) {
        if (*order != "newest" && *order != "oldest") return bad_query("order", "newest or oldest");
        query.oldest_first = *order == "oldest";
    }
    const auto state = query_alarm_state(c, fault);
    const auto form = event_form(c, fault);
    if (fault) return *fault;
    // A client finds the consequences of its last action here, although events wait for the disk.
    events.events_settled([&context = c.context, &events, query, state, form = *form, respond = c.respond] {
        auto list = state ? events_of_alarms(context.alarms->list(), events, query, *state) : events.events(query);
        std::ranges::sort(list, {}, &Event::id);
        respond(events_answer(list, form));
    });
    return {gateway_limit,
            problem(504, "no_answer", "the gateway did not say in time what has happened; ask again, and look at GET /health")};
}

}  // namespace axisgate::http
