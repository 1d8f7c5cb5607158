// Records are distributed as they come; a file is composed and written on the disk's own thread from shared chunks.
#include "gateway/runtime/warm_recorder.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <cstring>
#include <filesystem>
#include <map>
#include <utility>

#include "gateway/runtime/clock.hpp"
#include "gateway/services/recorder/axr.hpp"
#include "gateway/wire/frame_export.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
namespace fs = std::filesystem;
constexpr auto look_often = std::chrono::milliseconds(100), look_seldom = std::chrono::milliseconds(500);
/// At once, some 10 us: the records of a busy site in 100 ms take half a millisecond, during which no command would be answered.
constexpr std::size_t records_per_slice = 64;

/// The content of one file, taken on the service thread.
struct Frozen {
    RecordingInfo info;
    FlightLog::Chunks stretch, inputs;
    std::uint64_t outcomes_before = 0, lost = 0, gone = 0;
    std::int64_t unix_offset_ns = 0;
    std::shared_ptr<const SiteState> site;
    std::map<std::string, std::shared_ptr<const Description>> descriptions{};  ///< the descriptions that its drives name
};

json::object meta_of(const Frozen& f) {
    json::object lines, axes;
    for (std::size_t i = 0; i < f.site->line_ids.size(); ++i)
        lines[std::to_string(index_of(f.site->line_ids[i]))] = f.site->site.lines[i].name;
    for (std::size_t i = 0; i < f.site->axis_ids.size(); ++i)
        axes[std::to_string(index_of(f.site->axis_ids[i]))] = f.site->site.axes[i].name;
    return {{"why", f.info.why},
            {"who", f.info.who},
            {"version", f.info.version},
            {"at_unix_ns", f.info.at_unix_ns},
            {"from_unix_ns", f.info.from_unix_ns},
            {"to_unix_ns", f.info.to_unix_ns},
            {"unix_offset_ns", f.unix_offset_ns},
            {"automatic", f.info.automatic},
            {"not_replayable", f.info.not_replayable},
            {"outcomes_before", f.outcomes_before},
            {"records_gone", f.gone},
            {"records_lost", f.lost},
            {"lines", std::move(lines)},
            {"axes", std::move(axes)}};
}

void add_frames(AxrWriter& w, const Frozen& f) {
    std::map<std::uint16_t, std::vector<TraceEntry>> by_line;
    for (const auto& chunk : f.stretch) {
        FlightReader reader(chunk->bytes);
        while (const auto r = reader.next()) {
            const bool cable = r->kind == FlightKind::received || r->kind == FlightKind::sent;
            if (!cable && r->kind != FlightKind::twin_frame) continue;
            const auto frame = unpack<FrameRecord>(r->payload);
            if (!frame) continue;
            auto& list = by_line[static_cast<std::uint16_t>(r->index & ~flight_within)];
            TraceEntry e;
            e.sequence = list.size() + 1;
            e.at_unix_ns = ns_of(r->at) + f.unix_offset_ns;
            e.to_drive = frame->to_drive;
            e.simulated = !cable;
            e.frame = frame->frame;
            list.push_back(e);
        }
    }
    for (const auto& [line, entries] : by_line) {
        const auto it = std::ranges::find(f.site->line_ids, LineId{line});
        const std::string name = it == f.site->line_ids.end()
                                     ? fmt::format("line {}", line)
                                     : f.site->site.lines[static_cast<std::size_t>(it - f.site->line_ids.begin())].name;
        w.add(pcapng(entries, name));
    }
}

std::string packed(const Frozen& f) {
    AxrWriter w;
    w.begin(axr_meta);
    w.add(json::serialize(meta_of(f)));
    w.begin(axr_site);
    w.add(json::serialize(to_json(f.site->site)));
    w.begin(axr_descriptions);
    json::array descriptions;
    for (const auto& [name, d] : f.descriptions)
        descriptions.push_back(json::object{{"name", name}, {"text", d->text}});
    w.add(json::serialize(descriptions));
    const auto add = [&w](std::string_view name, const FlightLog::Chunks& chunks) {
        w.begin(name);
        for (const auto& c : chunks)
            w.add(c->bytes);
    };
    if (f.info.not_replayable.empty()) add(axr_inputs, f.inputs);
    add(axr_records, f.stretch);
    w.begin(axr_frames);
    add_frames(w, f);
    return w.finish();
}

RecordingInfo info_of(const std::string& path, std::string name) {
    RecordingInfo i;
    i.name = std::move(name);
    std::error_code ec;
    i.bytes = fs::file_size(path, ec);
    const std::string head = read_beginning(path);
    const auto text = axr_head(head, i.fault);
    boost::system::error_code unread;
    const auto meta = i.fault.empty() ? json::parse(text, unread) : json::value();
    const auto* o = meta.if_object();
    if (!o) {
        if (i.fault.empty()) i.fault = "what it says of itself cannot be read";
        return i;
    }
    const auto word = [&](std::string_view key) {
        const auto* v = o->if_contains(key);
        return v && v->is_string() ? std::string(v->get_string()) : std::string();
    };
    const auto number = [&](std::string_view key) {
        const auto* v = o->if_contains(key);
        return v && v->is_int64() ? v->get_int64() : 0;
    };
    i.why = word("why"), i.who = word("who"), i.version = word("version"), i.not_replayable = word("not_replayable");
    i.at_unix_ns = number("at_unix_ns"), i.from_unix_ns = number("from_unix_ns"), i.to_unix_ns = number("to_unix_ns");
    const auto* a = o->if_contains("automatic");
    i.automatic = a && a->is_bool() && a->get_bool();
    return i;
}
/// Splits "fault, limit".
std::vector<std::string> words_of(std::string_view list) {
    std::vector<std::string> words(1);
    for (const char c : list) {
        if (c == ',')
            words.emplace_back();
        else if (c != ' ')
            words.back() += c;
    }
    std::erase(words, "");
    return words;
}

}  // namespace

RecorderSettings recorder_settings(const Config& c) {
    RecorderSettings r;
    r.directory = c.data_dir + "/recordings";
    r.trend_length = std::chrono::minutes(c.recorder_trend_minutes);
    r.trend_bytes = static_cast<std::size_t>(c.recorder_trend_mb) << 20;
    r.stretch_bytes = static_cast<std::size_t>(c.recorder_stretch_mb) << 20;
    r.inputs_bytes = static_cast<std::size_t>(c.recorder_inputs_mb) << 20;
    r.trends = c.data_dir + "/trends";
    r.trend_disk_bytes = static_cast<std::uint64_t>(c.recorder_trend_disk_mb.value_or(200)) << 20;
    r.trend_disk_unmarked = c.recorder_trend_disk_mb.has_value();
    r.captures = c.data_dir + "/captures";
    r.captures_bytes = static_cast<std::uint64_t>(c.recorder_captures_mb) << 20;
    r.disk_bytes = static_cast<std::uint64_t>(c.recorder_disk_mb) << 20;
    r.freeze_on = words_of(c.recorder_freeze_on);
    return r;
}

WarmRecorder::Tap::~Tap() {
    ring.empty([](const FlightRecord& r) {
        if (r.kind != FlightKind::site) return;
        std::shared_ptr<const SiteInput>* owned = nullptr;
        std::memcpy(&owned, r.payload.data(), sizeof owned);
        delete owned;
    });
}

/// The site is passed on as it is, because encoding it takes longer than the hot thread may.
void WarmRecorder::Tap::take_site(std::shared_ptr<const SiteInput> input, Instant now) {
    auto* owned = new std::shared_ptr<const SiteInput>(std::move(input));
    if (!ring.push({FlightKind::site, 0xFFFF, now, {reinterpret_cast<const char*>(&owned), sizeof owned}})) delete owned;
}

WarmRecorder::~WarmRecorder() {
    if (trends_) threads_.hot.engine().set_tap(nullptr);  // its thread has ended, or was never started
    events_.unlisten(this);
    if (const auto site = sites_.site(); trend_disk_ && site) trend_disk_->end(*trends_, *site, monotonic_now(), unix_ns_of(at_ns(0)));
    end_disk();
}

void WarmRecorder::begin(RecorderSettings settings) {
    settings_ = std::move(settings);
    trends_ = std::make_unique<Trends>(settings_.trend_bytes, settings_.trend_length);
    stretch_ = std::make_unique<FlightLog>(settings_.stretch_bytes, true);
    inputs_ = std::make_unique<FlightLog>(settings_.inputs_bytes, false);
    shelf_.open(settings_.directory, info_of);
    if (settings_.trend_disk_bytes > 0) {
        trend_disk_ = std::make_unique<TrendDisk>(disk_, settings_.trends, settings_.trend_disk_bytes, settings_.trend_disk_unmarked);
        if (auto fault = trend_disk_->open(unix_now_ns(), unix_ns_of(at_ns(0)), settings_.trend_length); !fault.empty()) {
            Event e;
            e.kind = "recording";
            e.severity = Severity::warning;
            e.text = std::move(fault);
            events_.note(std::move(e));
        }
    }
    threads_.hot.engine().set_tap(&tap_);
    events_.listen(this);
    timer_ = std::make_unique<boost::asio::steady_timer>(threads_.warm);
    alarm_timer_ = std::make_unique<boost::asio::steady_timer>(threads_.warm);
    wait(look_seldom);
}

void WarmRecorder::wait(std::chrono::milliseconds pause) {
    timer_->expires_after(pause);
    timer_->async_wait([this](const boost::system::error_code& ec) {
        if (ec) return;
        if (!take(records_per_slice)) return wait({});  // behind work that has arrived for others meanwhile
        end_look();
        wait(std::exchange(found_, false) ? look_often : look_seldom);
    });
}

void WarmRecorder::empty() {
    if (!trends_) return;
    (void)take(SIZE_MAX);
    end_look();
}

bool WarmRecorder::take(std::size_t most) {
    return tap_.ring.empty(
        [this](const FlightRecord& r) {
            found_ = true;
            if (r.kind != FlightKind::site) return keep(r);
            std::shared_ptr<const SiteInput>* owned = nullptr;
            std::memcpy(&owned, r.payload.data(), sizeof owned);
            const std::unique_ptr<std::shared_ptr<const SiteInput>> site(owned);
            const std::string written = pack_site(**site);
            keep({r.kind, r.index, r.at, written});
        },
        most);
}

void WarmRecorder::end_look() {
    if (tap_.ring.lost() > 0 && !inputs_->overflowed()) inputs_->give_up();
    if (listener_) listener_->on_time(monotonic_now());
    if (const auto site = sites_.site(); trend_disk_ && site) trend_disk_->keep(*trends_, *site, monotonic_now(), unix_ns_of(at_ns(0)));
}

void WarmRecorder::keep(const FlightRecord& r) {
    stretch_->add(r);
    if (is_input(r.kind)) inputs_->add(r);
    if (r.kind == FlightKind::command && listener_) {
        if (const auto c = unpack<CommandRecord>(r.payload)) listener_->on_command(c->command, r.at);
    }
    if (r.kind != FlightKind::picture) return;
    if (const auto p = unpack<PictureRecord>(r.payload)) {
        if (const auto site = sites_.site(); trend_disk_ && site) trend_disk_->bring_back(AxisId{r.index}, *trends_, *site);
        trends_->add(AxisId{r.index}, *p, r.at);
        if (listener_) listener_->on_picture(AxisId{r.index}, *p, r.at);
    }
}

TrendStretch WarmRecorder::trend(AxisId axis, Instant from, Instant to, std::size_t columns) {
    empty();
    return trends_ ? trends_->read(axis, from, to, columns) : TrendStretch{};
}

std::string WarmRecorder::not_replayable() const {
    if (tap_.ring.lost() > 0) return fmt::format("{} records were lost on their way: the service had no time for them", tap_.ring.lost());
    if (inputs_ && inputs_->overflowed())
        return fmt::format("the gateway has run too long: the inputs since its start need more than the {} MB of [recorder] inputs_mb",
                           settings_.inputs_bytes >> 20);
    return "";
}

RecorderState WarmRecorder::recorder_state() {
    empty();
    RecorderState s;
    s.lost = tap_.ring.lost();
    if (stretch_) {
        s.bytes = stretch_->bytes();
        if (const auto chunks = stretch_->chunks(); !chunks.empty()) s.from = chunks.front()->first;
    }
    s.bound = settings_.stretch_bytes;
    s.not_replayable = not_replayable();
    s.trend_bytes = trends_ ? trends_->bytes() : 0;
    s.trend_bound = settings_.trend_bytes;
    s.trend_minutes = std::chrono::duration<double, std::ratio<60>>(settings_.trend_length).count();
    s.disk_bytes = shelf_.bytes();
    s.disk_bound = settings_.disk_bytes;
    s.disk_fault = shelf_.disk_fault();
    return s;
}

void WarmRecorder::read_stretch(Instant from, std::function<void(const FlightRecord&)> each, std::function<void()> then) {
    empty();
    auto chunks = stretch_ ? stretch_->chunks() : FlightLog::Chunks{};
    boost::asio::post(disk_, [this, from, chunks = std::move(chunks), each = std::move(each), then = std::move(then)]() mutable {
        for (const auto& chunk : chunks) {
            if (chunk->last < from) continue;
            FlightReader reader(chunk->bytes);
            while (const auto r = reader.next())
                if (r->at >= from) each(*r);
        }
        threads_.answer(std::move(then));
    });
}

void WarmRecorder::freeze(std::string name, std::string why, std::string who, std::function<void(RecordingFault, RecordingInfo)> then) {
    freeze_this(std::move(name), std::move(why), std::move(who), false, std::move(then));
}

void WarmRecorder::freeze_this(std::string name, std::string why, std::string who, bool automatic,
                               std::function<void(RecordingFault, RecordingInfo)> then) {
    using Kind = RecordingFault::Kind;
    const auto refuse = [&](Kind kind, std::string text) { then({kind, std::move(text)}, {}); };
    if (!trends_) return refuse(Kind::busy, "nothing is recorded yet");
    if (shelf_.writing()) return refuse(Kind::busy, "another recording is being written: try again");
    if (shelf_.kept().contains(name)) return then(shelf_.exists(name), {});
    if (automatic) make_room_for_automatic();
    if (shelf_.full(settings_.disk_bytes))
        return refuse(Kind::no_room, fmt::format("{} recordings take {} MB of {} MB: delete some", shelf_.kept().size(),
                                                 shelf_.bytes() >> 20, settings_.disk_bytes >> 20));
    empty();
    auto f = std::make_shared<Frozen>();
    f->stretch = stretch_->chunks();
    f->inputs = inputs_->chunks();
    f->outcomes_before = stretch_->gone_outcomes();
    f->gone = stretch_->gone();
    f->lost = tap_.ring.lost();
    f->unix_offset_ns = unix_ns_of(at_ns(0));
    f->site = sites_.site();
    for (const auto& d : f->site->site.drives) {
        const auto& shelf = sites_.families().descriptions;
        if (const auto text = d.description.empty() || !shelf ? nullptr : shelf->find(d.description)) f->descriptions[d.description] = text;
    }
    f->info.name = std::move(name);
    f->info.why = std::move(why);
    f->info.who = std::move(who);
    f->info.version = AXISGATE_VERSION;
    f->info.automatic = automatic;
    f->info.at_unix_ns = unix_now_ns();
    if (!f->stretch.empty()) {
        f->info.from_unix_ns = ns_of(f->stretch.front()->first) + f->unix_offset_ns;
        f->info.to_unix_ns = ns_of(f->stretch.back()->last) + f->unix_offset_ns;
    }
    f->info.not_replayable = not_replayable();
    shelf_.write(
        f->info, [f] { return packed(*f); }, std::move(then));
}

/// Deletes the oldest automatic recordings; requested ones stay.
void WarmRecorder::make_room_for_automatic() {
    while (shelf_.full(settings_.disk_bytes) || shelf_.bytes() + settings_.stretch_bytes + settings_.inputs_bytes > settings_.disk_bytes) {
        const RecordingInfo* oldest = nullptr;
        for (const auto& [name, info] : shelf_.kept()) {
            if (info.automatic && (!oldest || info.at_unix_ns < oldest->at_unix_ns)) oldest = &info;
        }
        if (!oldest) return;
        shelf_.remove(std::string(oldest->name), [](const RecordingFault&) {});
    }
}

void WarmRecorder::on_event(const Event& e) {
    if (e.severity != Severity::alarm || std::ranges::find(settings_.freeze_on, e.kind) == settings_.freeze_on.end()) return;
    const Instant now = monotonic_now();
    if (frozen_at_ != Instant{} && now - frozen_at_ < between_alarms) return;
    frozen_at_ = now;
    std::string why = fmt::format("{} {}: {}", e.kind, e.axis.empty() ? e.line : e.axis, e.text);
    alarm_timer_->expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(after_alarm));
    alarm_timer_->async_wait([this, why = std::move(why)](const boost::system::error_code& ec) mutable {
        if (ec) return;
        const std::time_t s = unix_now_ns() / 1'000'000'000;
        freeze_this(fmt::format("alarm-{:%Y%m%d-%H%M%S}", fmt::gmtime(s)), std::move(why), "", true,
                    [this](const RecordingFault& fault, const RecordingInfo& info) {
                        Event published;
                        published.kind = "recording";
                        published.severity = fault.text.empty() ? Severity::info : Severity::warning;
                        published.text = fault.text.empty() ? fmt::format("recording {} was made: {}", info.name, info.why) : fault.text;
                        events_.note(std::move(published));
                    });
    });
}

void WarmRecorder::play_back(const std::string& name, PlaybackWish wish, std::function<void(RecordingFault, json::object)> then) {
    Families families = sites_.families();
    families.descriptions = std::make_shared<DescriptionShelf>();  // descriptions in the recording are valid for it only
    shelf_.read<std::pair<std::string, json::object>>(
        name,
        [families = std::move(families), wish](const std::string& bytes) {
            std::pair<std::string, json::object> out;
            out.second = axisgate::play_back(bytes, families, wish, out.first);
            return out;
        },
        [then = std::move(then)](std::optional<std::pair<std::string, json::object>> done) {
            if (!done) return then({RecordingFault::Kind::no_such, ""}, {});
            if (!done->first.empty()) return then({RecordingFault::Kind::damaged, done->first}, {});
            then({}, std::move(done->second));
        });
}

}  // namespace axisgate
