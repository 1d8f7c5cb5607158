// Asks each source for its version once per period and gives the same frame to all subscribers. A missed period is not repeated, and a slow
// client is not waited for.
#include "gateway/doors/http/stream_hub.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/text.hpp"
#include "gateway/doors/http/websocket_codec.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/command_reader.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// "axes/*" for "axes/feeder".
std::string wildcard_of(std::string_view topic) { return std::string(topic.substr(0, topic.find('/'))) + "/*"; }

/// The line's name in "lines/NAME/frames"; empty if it is another topic. (A name has no slash.)
std::string_view line_of_frames(std::string_view topic) {
    constexpr std::string_view head = "lines/", tail = "/frames";
    if (topic.size() <= head.size() + tail.size() || !topic.starts_with(head) || !topic.ends_with(tail)) return {};
    return topic.substr(head.size(), topic.size() - head.size() - tail.size());
}

json::object frames_document(FrameDecoder& decoder, const std::vector<TraceEntry>& entries, std::size_t from, std::uint64_t missed) {
    json::array list;
    for (std::size_t i = from; i < entries.size(); ++i)
        list.push_back(frame_document(entries[i], decoder.read(entries[i])));
    return {{"missed", missed}, {"frames", std::move(list)}};
}
}  // namespace

void StreamClient::close(std::uint16_t code, std::string_view reason) {
    if (closing_) return;
    closing_ = code;
    queue.clear();
    queue.push_control(std::make_shared<const std::string>(close_frame(code, reason)));
    has_work_ = true;
}

StreamHub::StreamHub(const Needs& ports, const Settings& settings, Counters& counters, std::function<void()> rearm)
    : axes_(ports.get<AxisPort>()),
      clock_(ports.get<ClockPort>()),
      events_(ports.get<EventPort>()),
      lines_(ports.get<LinePort>()),
      sites_(ports.get<SitePort>()),
      settings_(settings),
      counters_(counters),
      rearm_(std::move(rearm)),
      sources_(ports) {
    sources_.take_site(sites_.site());
    events_.listen(this);
    sites_.listen(this);
}

StreamHub::~StreamHub() { detach(); }

void StreamHub::detach() {
    if (attached_) {
        events_.unlisten(this);
        sites_.unlisten(this);
    }
    attached_ = false;
}

std::shared_ptr<StreamClient> StreamHub::add(std::function<void()> wake) {
    clients_.push_back(std::make_shared<StreamClient>(settings_.max_events_waiting, std::move(wake)));
    counters_.stream_clients = clients_.size();
    return clients_.back();
}

void StreamHub::remove(const std::shared_ptr<StreamClient>& client) {
    clients_.remove(client);
    // Its loss is reported at once, without waiting until its set-points expire; unless the same client sends some over another feed, which
    // this feed cannot know.
    const auto& who = client->gives_set_points_;
    if (attached_ && who && std::ranges::none_of(clients_, [&](const auto& c) { return c->gives_set_points_ == who; }))
        axes_.client_lost(*who, LossCause::set_points_silent);
    counters_.stream_clients = clients_.size();
    const auto used = periods();
    std::erase_if(groups_, [&](const auto& g) { return !used.contains(g.first); });
}

Instant StreamHub::deadline() const {
    if (new_site_ || !due_.empty()) return time_zero;
    Instant next = never;
    for (const auto& [period, at] : groups_)
        next = std::min(next, at);
    return next;
}

void StreamHub::on_text(StreamClient& c, std::string_view text, Instant now) {
    if (c.closing_) return;
    take_site(now);
    std::string fault;
    const auto request = read_stream_request(text, fault);
    if (!request) {
        send_error(c, fault);
        if (++c.wrong_in_a_row_ >= wrong_requests) c.close(close_unsupported, "three messages in a row were not a request");
        wake(c);
        return;
    }
    if (!may_ask(c, *request, now)) {
        c.close(close_policy, "too many requests: subscribe once, and change what you watch at most a few times a second");
        return wake(c);
    }
    c.wrong_in_a_row_ = 0;
    if (!request->set_point.empty()) give_set_point(c, request->set_point, now);
    if (request->subscribe.empty() && request->unsubscribe.empty()) return wake(c);
    for (const auto& topic : request->unsubscribe)
        unsubscribe(c, topic);
    for (const auto& topic : request->subscribe)
        subscribe(c, topic, request->period_ms);
    resolve(c, now, &request->subscribe);
    keep_groups(now);
    wake(c);
    if (rearm_) rearm_();
}

bool StreamHub::may_ask(StreamClient& c, const StreamRequest& request, Instant now) {
    const bool alone = request.subscribe.empty() && request.unsubscribe.empty();
    double cost = (alone ? 0.02 : 1) + static_cast<double>(request.subscribe.size() + request.unsubscribe.size()) / 50;
    for (const auto& topic : request.subscribe)
        cost += topic.ends_with("/frames") ? 4 : 0;
    c.asked_ = std::max(0.0, c.asked_ - seconds(now - c.asked_at_) * allowance_per_s) + cost;
    c.asked_at_ = now;
    return c.asked_ <= allowance;
}

/// Passed on without an answer; only a refusal is reported to the client.
void StreamHub::give_set_point(StreamClient& c, const json::object& body, Instant now) {
    auto origin = c.commander ? c.commander() : std::nullopt;
    if (!origin) return send_error(c, "set-points need the role operator or a higher one");
    const auto* name = body.if_contains("axis");
    const auto place = name && name->is_string() ? find_axis(sites_, std::string_view(name->get_string())) : std::nullopt;
    if (!place)
        return send_error(c, name && name->is_string() ? fmt::format("there is no axis {}", std::string_view(name->get_string()))
                                                       : "a set-point needs \"axis\", its name");
    auto read = read_set_point(body, place->spec().increments_per_unit, place->spec().unit);
    if (!read.set_point) return send_error(c, fmt::format("set_point: {}: {}", read.faults.front().text, read.faults.front().remedy));
    read.set_point->axis = place->id();
    read.set_point->at = now;
    c.gives_set_points_ = AuthorityClient::of(*origin);
    read.set_point->origin = std::move(*origin);
    axes_.set_point(std::move(*read.set_point));
}

void StreamHub::subscribe(StreamClient& c, const std::string& topic, std::int64_t period_ms) {
    if (c.topics_.size() >= most_topics && !c.topics_.contains(topic))
        return send_error(c, fmt::format("at most {} topics", most_topics), topic);
    if (topic == "events") {
        c.events_ = true;
    } else if (topic == "site") {
        c.site_ = true;
        send_site(c);
    } else if (topic == "recipes") {
        c.recipes_ = true;
        for (const auto& report : recipes_now ? recipes_now() : std::vector<json::object>())
            put_state(c, recipe_number(std::string(report.at("recipe").get_string())),
                      stream_message("recipes", clock_.now_unix_ns(), report));
    } else if (topic == "alarms") {
        c.alarms_ = true;
        if (alarms_number_ == 0) alarms_number_ = sources_.next_number();
        if (alarms_now) put_state(c, alarms_number_, stream_message("alarms", clock_.now_unix_ns(), alarms_now()));
    } else if (const auto line = line_of_frames(topic); !line.empty() && sources_.find(fmt::format("lines/{}", line))) {
        auto it = std::ranges::find(c.frames_, topic, &StreamClient::FrameWatch::topic);
        if (it == c.frames_.end()) {
            c.frames_.push_back({std::string(line), topic, sources_.next_number(), period_ms, no_line, 0});
            it = std::prev(c.frames_.end());
        }
        it->period_ms = period_ms;
        begin_frames(c, *it);
    } else if (topic != "axes/*" && topic != "drives/*" && topic != "lines/*" && !sources_.find(topic)) {
        return send_error(c,
                          "there is no such topic: use axes/*, axes/NAME, drives/*, drives/NAME, lines/*, lines/NAME, lines/NAME/frames, "
                          "events, alarms, recipes, site",
                          topic);
    }
    c.topics_.insert_or_assign(topic, period_ms);
}

void StreamHub::unsubscribe(StreamClient& c, const std::string& topic) {
    if (c.topics_.erase(topic) == 0) return send_error(c, "this topic is not subscribed", topic);
    if (topic == "events") c.events_ = false;
    if (topic == "site") c.site_ = false;
    if (topic == "recipes") c.recipes_ = false;
    if (topic == "alarms") c.alarms_ = false;
    std::erase_if(c.frames_, [&](const auto& f) { return f.topic == topic; });
}

void StreamHub::resolve(StreamClient& c, Instant now, const std::vector<std::string>* snapshots_of) {
    std::map<std::uint32_t, std::uint64_t> sent;
    for (const auto& [period, list] : c.watches_) {
        for (const auto& w : list)
            sent.emplace(w.source->number, w.sent_version);
    }
    c.watches_.clear();
    const auto asked_now = [&](const std::string& topic) {
        return snapshots_of && std::ranges::find(*snapshots_of, topic) != snapshots_of->end();
    };
    std::map<std::string_view, bool> wildcard_now;
    for (const std::string_view w : {"axes/*", "drives/*", "lines/*"})
        wildcard_now[w] = asked_now(std::string(w));
    for (const auto& [topic, source] : sources_.all()) {
        auto subscription = c.topics_.find(topic);
        const std::string wildcard = wildcard_of(topic);
        const bool by_name = subscription != c.topics_.end();
        if (!by_name) subscription = c.topics_.find(wildcard);
        if (subscription == c.topics_.end()) continue;
        StreamClient::Watch watch{source, 0};
        const auto before = sent.find(source->number);
        const bool snapshot = before == sent.end() || wildcard_now[wildcard] || (by_name && asked_now(topic));
        if (snapshot) {
            (void)sources_.look(*source, now, true);
            watch.sent_version = source->version;
            if (source->frame) put_state(c, source->number, source->frame);
        } else {
            watch.sent_version = before->second;
        }
        c.watches_[subscription->second].push_back(std::move(watch));
    }
}

std::set<std::int64_t> StreamHub::periods() const {
    std::set<std::int64_t> out;
    for (const auto& c : clients_) {
        for (const auto& [period, list] : c->watches_)
            out.insert(period);
        for (const auto& f : c->frames_)
            out.insert(f.period_ms);
    }
    return out;
}

void StreamHub::keep_groups(Instant now) {
    const auto used = periods();
    std::erase_if(groups_, [&](const auto& g) { return !used.contains(g.first); });
    for (const auto period : used)
        groups_.emplace(period, now + std::chrono::milliseconds(period));
}

LineId StreamHub::line_id(std::string_view line) const {
    const auto source = sources_.find(fmt::format("lines/{}", line));
    return source && source->index < sources_.site().line_ids.size() ? sources_.site().line_ids[source->index] : no_line;
}

void StreamHub::on_deadline(Instant now) {
    take_site(now);
    for (auto& [period_ms, at] : groups_) {
        if (at > now) continue;
        const auto period = std::chrono::milliseconds(period_ms);
        at += period;
        if (at <= now) at = now + period;  // late: missed periods are not repeated
        // The previous period is not finished: this one is left out, as for a late call.
        if (std::ranges::find(due_, period_ms, &Due::period_ms) != due_.end()) continue;
        for (const auto& c : clients_) {
            const bool watches = c->watches_.contains(period_ms) ||
                                 std::ranges::find(c->frames_, period_ms, &StreamClient::FrameWatch::period_ms) != c->frames_.end();
            if (watches && !c->closing_) due_.push_back({c, period_ms, now, 0});
        }
    }
    tell_next();
}

/// A few looks at the subscriptions of the next client, or its messages when all looks are done, which later clients share.
void StreamHub::tell_next() {
    if (due_.empty()) return;
    Due& d = due_.front();
    const auto c = d.client.lock();
    if (c && !c->closing_) {
        const auto list = c->watches_.find(d.period_ms);
        const std::size_t all = list == c->watches_.end() ? 0 : list->second.size();
        for (int made = 0; d.looked < all; ++d.looked) {
            if (made >= looks_per_slice) return;
            made += sources_.look(*list->second[d.looked].source, d.at) ? 1 : 0;
        }
        send(*c, d.period_ms, d.at);
    }
    due_.pop_front();
}

void StreamHub::send(StreamClient& c, std::int64_t period_ms, Instant at) {
    if (const auto list = c.watches_.find(period_ms); list != c.watches_.end()) send_states(c, list->second, at);
    for (auto& f : c.frames_) {
        if (f.period_ms == period_ms) send_frames(c, f, at);
    }
    wake(c);
}

void StreamHub::send_states(StreamClient& c, std::vector<StreamClient::Watch>& list, Instant at) {
    const bool together = c.takes_at_once && c.queue.empty() && list.size() <= most_joined;
    changed_.clear();
    for (auto& w : list) {
        (void)sources_.look(*w.source, at);
        if (w.sent_version == w.source->version) continue;
        w.sent_version = w.source->version;
        if (together) {
            changed_.push_back(w.source->frame);
        } else {
            put_state(c, w.source->number, w.source->frame);
        }
    }
    if (changed_.empty()) return;
    c.queue.push_states(joined());
    counters_.stream_frames_sent += changed_.size() - 1;
    c.has_work_ = true;
}

/// The changes as the bytes of one write. Clients with the same subscriptions share them, which saves each of them the queue.
SharedFrame StreamHub::joined() {
    auto& last = last_joined_;
    if (last.parts == changed_) return last.all;
    auto all = std::make_shared<std::string>();
    for (const auto& f : changed_)
        all->append(*f);
    last.parts = changed_;
    last.all = std::move(all);
    return last.all;
}

void StreamHub::begin_frames(StreamClient& c, StreamClient::FrameWatch& watch) {
    const LineId id = line_id(watch.line);
    if (id == no_line) return;
    watch.id = id;
    // The newest ones, whatever the number of stored frames is: reads to the end, keeps the last part.
    Trace trace = lines_.trace(id, 0, most_frames);
    for (int i = 0; i < 64 && trace.entries.size() == most_frames; ++i) {
        Trace more = lines_.trace(id, trace.next, most_frames);
        if (more.entries.empty()) break;
        trace = std::move(more);
    }
    watch.since = trace.next;
    const std::size_t from = trace.entries.size() > first_frames ? trace.entries.size() - first_frames : 0;
    put_state(
        c, watch.number,
        stream_message(watch.topic, clock_.now_unix_ns(), frames_document(decoder_for(watch.line, 0, trace.next), trace.entries, from, 0)));
}

/// The decoder that has read this line up to `since`, or a new one. At most one per line is kept.
FrameDecoder& StreamHub::decoder_for(const std::string& line, std::uint64_t since, std::uint64_t next) {
    auto& kept = decoders_[line];
    if (!kept.decoder || since == 0 || kept.next != since) {
        kept.decoder = std::make_unique<FrameDecoder>(sites_.families(), sources_.site().site, line);
    }
    kept.next = next;
    return *kept.decoder;
}

void StreamHub::send_frames(StreamClient& c, StreamClient::FrameWatch& watch, Instant now) {
    // The previous list is still waiting, because this client is slow. Its position in the recording is kept; overwritten frames are
    // counted.
    if (c.queue.state_waits(watch.number)) return;
    const LineId id = line_id(watch.line);
    if (id == no_line) return;
    if (id != watch.id) return begin_frames(c, watch);  // another line of that name: its numbers begin anew
    auto& last = last_frames_;
    const bool same = last.message && last.at == now && last.line == watch.line && last.since == watch.since;
    if (!same) {
        const auto trace = lines_.trace(id, watch.since, most_frames);
        last.at = now;
        last.line = watch.line;
        last.since = watch.since;
        last.missed = trace.missed;
        last.next = trace.next;
        last.frames = trace.entries.size();
        last.message = stream_message(
            watch.topic, clock_.now_unix_ns(),
            frames_document(decoder_for(watch.line, trace.missed > 0 ? 0 : watch.since, trace.next), trace.entries, 0, trace.missed));
    }
    watch.since = last.next;
    if (last.frames > 0 || last.missed > 0) put_state(c, watch.number, last.message);
}

void StreamHub::send_site(StreamClient& c) {
    put_event(c, stream_message("site", clock_.now_unix_ns(), json::object{{"revision", sources_.site().revision}}));
}

void StreamHub::send_error(StreamClient& c, std::string_view text, std::string_view topic) {
    ++counters_.stream_requests_wrong;
    json::object data{{"text", text}};
    if (!topic.empty()) data["topic"] = topic.substr(0, 256);
    put_event(c, stream_message("error", clock_.now_unix_ns(), data));
}

void StreamHub::put_event(StreamClient& c, SharedFrame frame) {
    if (c.closing_) return;
    if (!c.queue.push_event(std::move(frame))) {
        c.close(close_try_later, fmt::format("more than {} events wait: read faster, and ask /api/v1/events for what is missing",
                                             settings_.max_events_waiting));
    }
    c.has_work_ = true;
}

void StreamHub::put_state(StreamClient& c, std::uint32_t number, SharedFrame frame) {
    if (c.closing_) return;
    if (c.queue.push_state(number, std::move(frame))) ++counters_.stream_states_replaced;
    c.has_work_ = true;
}

void StreamHub::wake(StreamClient& c) {
    if (!c.has_work_) return;
    c.has_work_ = false;
    if (c.wake_) c.wake_();
}

std::uint32_t StreamHub::recipe_number(const std::string& recipe) {
    const auto it = recipe_numbers_.find(recipe);
    return it != recipe_numbers_.end() ? it->second : recipe_numbers_.emplace(recipe, sources_.next_number()).first->second;
}

void StreamHub::on_recipe(const std::string& recipe, const json::object& report) {
    SharedFrame frame;
    for (const auto& c : clients_) {
        if (!c->recipes_ || c->closing_) continue;
        if (!frame) frame = stream_message("recipes", clock_.now_unix_ns(), report);
        put_state(*c, recipe_number(recipe), frame);
        wake(*c);
    }
}

void StreamHub::on_alarms(const json::object& list) {
    SharedFrame frame;
    for (const auto& c : clients_) {
        if (!c->alarms_ || c->closing_) continue;
        if (!frame) frame = stream_message("alarms", clock_.now_unix_ns(), list);
        put_state(*c, alarms_number_, frame);
        wake(*c);
    }
}

void StreamHub::on_event(const Event& event) {
    SharedFrame frame;
    for (const auto& c : clients_) {
        if (!c->events_ || c->closing_) continue;
        if (!frame) frame = stream_message("events", event.at_unix_ns, event_document(event));
        put_event(*c, frame);
        wake(*c);
    }
}

void StreamHub::on_site(const std::shared_ptr<const SiteState>& site) {
    // Snapshots need an instant, which the next on_deadline has; it is due at once.
    new_site_ = site;
    if (rearm_) rearm_();
}

void StreamHub::take_site(Instant now) {
    if (!new_site_) return;
    const auto before = sources_.all();
    sources_.take_site(std::move(new_site_));
    new_site_.reset();
    decoders_.clear();
    std::vector<std::shared_ptr<Source>> gone;
    for (const auto& [topic, source] : before) {
        if (!sources_.find(topic)) gone.push_back(source);
    }
    for (const auto& c : clients_) {
        if (c->closing_) continue;
        for (const auto& source : gone) {
            const bool watched = c->topics_.contains(source->topic) || c->topics_.contains(wildcard_of(source->topic));
            if (watched) put_state(*c, source->number, stream_message(source->topic, clock_.now_unix_ns(), nullptr));
            c->topics_.erase(source->topic);
            if (source->kind == Source::Kind::line) {
                c->topics_.erase(source->topic + "/frames");
                std::erase_if(c->frames_, [&](const auto& f) { return f.topic == source->topic + "/frames"; });
            }
        }
        resolve(*c, now, nullptr);
        if (c->site_) send_site(*c);
        wake(*c);
    }
    keep_groups(now);
}

}  // namespace axisgate::http
