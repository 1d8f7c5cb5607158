// Warm recorder: records are sorted as they come; a file is put together and written on the disk's own thread from shared chunks.
// In: records. Out: trends, files. Never writes from the service thread.
#include "gateway/runtime/warm_recorder.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "gateway/runtime/clock.hpp"
#include "gateway/services/recorder/axr.hpp"
#include "gateway/store/files.hpp"
#include "gateway/wire/frame_export.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
namespace fs = std::filesystem;
constexpr auto look_often = std::chrono::milliseconds(100), look_seldom = std::chrono::milliseconds(500);

/// All that goes into one file, taken on the service thread.
struct Frozen {
    RecordingInfo info;
    FlightLog::Chunks stretch, inputs;
    std::uint64_t outcomes_before = 0, lost = 0, gone = 0;
    std::int64_t unix_offset_ns = 0;
    std::shared_ptr<const SiteState> site;
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

/// Empty, or why it is not on the disk; then nothing of it is.
std::string put_on_disk(const std::string& path, const std::string& directory, const std::string& bytes) {
    if (const auto made = files::make_directory(directory); !made) return made.error().text;
    const std::string fresh = path + ".new";
    std::string fault;
    if (const auto made = files::create(fresh, directory); !made) return made.error().text;
    {
        std::ofstream out(fresh, std::ios::binary | std::ios::trunc);
        errno = 0;
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        out.close();
        if (!out) fault = fmt::format("{} cannot be written: {}", path, errno != 0 ? std::strerror(errno) : "the disk is full");
    }
    if (fault.empty()) {
        if (const auto done = files::sync(fresh, directory); !done) fault = done.error().text;
    }
    if (fault.empty()) {
        if (const auto done = files::rename(fresh, path, directory); !done) fault = done.error().text;
    }
    std::error_code ec;
    if (!fault.empty()) (void)fs::remove(fresh, ec);
    return fault;
}

RecordingInfo info_of(const fs::path& path) {
    RecordingInfo i;
    i.name = path.stem().string();
    std::error_code ec;
    i.bytes = fs::file_size(path, ec);
    std::string head(1u << 20, '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
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
/// "fault, limit" taken apart.
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

/// The site goes as it is: to write it down takes longer than the hot thread has.
void WarmRecorder::Tap::take_site(std::shared_ptr<const SiteInput> input, Instant now) {
    auto* owned = new std::shared_ptr<const SiteInput>(std::move(input));
    if (!ring.push({FlightKind::site, 0xFFFF, now, {reinterpret_cast<const char*>(&owned), sizeof owned}})) delete owned;
}

WarmRecorder::~WarmRecorder() {
    if (trends_) threads_.hot.engine().set_tap(nullptr);  // its thread has ended, or was never begun
    events_.unlisten(this);
    disk_.stop();
    disk_.join();
}

void WarmRecorder::begin(RecorderSettings settings) {
    settings_ = std::move(settings);
    trends_ = std::make_unique<Trends>(settings_.trend_bytes, settings_.trend_length);
    stretch_ = std::make_unique<FlightLog>(settings_.stretch_bytes, true);
    inputs_ = std::make_unique<FlightLog>(settings_.inputs_bytes, false);
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(settings_.directory, ec)) {
        if (kept_.size() >= most_recordings) break;
        if (entry.path().extension() == ".new") (void)fs::remove(entry.path(), ec);  // a writing that was cut off
        if (entry.path().extension() != ".axr" || !check_recording_name(entry.path().stem().string()).empty()) continue;
        auto info = info_of(entry.path());
        kept_[info.name] = std::move(info);
    }
    threads_.hot.engine().set_tap(&tap_);
    events_.listen(this);
    timer_ = std::make_unique<boost::asio::steady_timer>(threads_.warm);
    alarm_timer_ = std::make_unique<boost::asio::steady_timer>(threads_.warm);
    wait();
}

void WarmRecorder::wait() {
    timer_->expires_after(found_ ? look_often : look_seldom);
    timer_->async_wait([this](const boost::system::error_code& ec) {
        if (ec) return;
        empty();
        wait();
    });
}

void WarmRecorder::empty() {
    found_ = false;
    if (!trends_) return;
    tap_.ring.empty([this](const FlightRecord& r) {
        found_ = true;
        if (r.kind != FlightKind::site) return keep(r);
        std::shared_ptr<const SiteInput>* owned = nullptr;
        std::memcpy(&owned, r.payload.data(), sizeof owned);
        const std::unique_ptr<std::shared_ptr<const SiteInput>> site(owned);
        const std::string written = pack_site(**site);
        keep({r.kind, r.index, r.at, written});
    });
    if (tap_.ring.lost() > 0 && !inputs_->overflowed()) inputs_->give_up();
}

void WarmRecorder::keep(const FlightRecord& r) {
    stretch_->add(r);
    if (is_input(r.kind)) inputs_->add(r);
    if (r.kind != FlightKind::picture) return;
    if (const auto p = unpack<PictureRecord>(r.payload)) trends_->add(AxisId{r.index}, *p, r.at);
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

std::uint64_t WarmRecorder::disk_bytes() const {
    std::uint64_t n = 0;
    for (const auto& [name, info] : kept_)
        n += info.bytes;
    return n;
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
    s.disk_bytes = disk_bytes();
    s.disk_bound = settings_.disk_bytes;
    s.disk_fault = disk_fault_;
    return s;
}

std::vector<RecordingInfo> WarmRecorder::recordings() const {
    std::vector<RecordingInfo> out;
    for (const auto& [name, info] : kept_)
        out.push_back(info);
    std::ranges::sort(out, [](const auto& a, const auto& b) { return a.at_unix_ns > b.at_unix_ns; });
    return out;
}

void WarmRecorder::freeze(std::string name, std::string why, std::string who, std::function<void(RecordingFault, RecordingInfo)> then) {
    freeze_this(std::move(name), std::move(why), std::move(who), false, std::move(then));
}

void WarmRecorder::freeze_this(std::string name, std::string why, std::string who, bool automatic,
                               std::function<void(RecordingFault, RecordingInfo)> then) {
    using Kind = RecordingFault::Kind;
    const auto refuse = [&](Kind kind, std::string text) { then({kind, std::move(text)}, {}); };
    if (!trends_) return refuse(Kind::busy, "nothing is recorded yet");
    if (writing_) return refuse(Kind::busy, "another recording is being written: try again");
    if (kept_.contains(name)) return refuse(Kind::exists, fmt::format("there is a recording {} already: choose another name", name));
    if (automatic) make_room_for_automatic();
    if (kept_.size() >= most_recordings || disk_bytes() >= settings_.disk_bytes)
        return refuse(Kind::no_room, fmt::format("{} recordings take {} MB of {} MB: delete some", kept_.size(), disk_bytes() >> 20,
                                                 settings_.disk_bytes >> 20));
    empty();
    auto f = std::make_shared<Frozen>();
    f->stretch = stretch_->chunks();
    f->inputs = inputs_->chunks();
    f->outcomes_before = stretch_->gone_outcomes();
    f->gone = stretch_->gone();
    f->lost = tap_.ring.lost();
    f->unix_offset_ns = unix_ns_of(at_ns(0));
    f->site = sites_.site();
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
    writing_ = true;
    boost::asio::post(disk_, [this, f, path = path_of(f->info.name), then = std::move(then)]() mutable {
        const std::string bytes = packed(*f);
        f->info.bytes = bytes.size();
        auto fault = put_on_disk(path, settings_.directory, bytes);
        threads_.answer([this, f, fault = std::move(fault), then = std::move(then)] {
            writing_ = false;
            disk_fault_ = fault;
            if (!fault.empty()) return then({Kind::no_room, "the recording is not written: " + fault}, {});
            kept_[f->info.name] = f->info;
            then({}, f->info);
        });
    });
}

/// The oldest that nobody asked for make room; what somebody has asked for stays.
void WarmRecorder::make_room_for_automatic() {
    while (kept_.size() >= most_recordings || disk_bytes() + settings_.stretch_bytes + settings_.inputs_bytes > settings_.disk_bytes) {
        const RecordingInfo* oldest = nullptr;
        for (const auto& [name, info] : kept_) {
            if (info.automatic && (!oldest || info.at_unix_ns < oldest->at_unix_ns)) oldest = &info;
        }
        if (!oldest) return;
        boost::asio::post(disk_, [path = path_of(oldest->name)] {
            std::error_code ec;
            (void)fs::remove(path, ec);
        });
        kept_.erase(std::string(oldest->name));
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
                        Event told;
                        told.kind = "recording";
                        told.severity = fault.text.empty() ? Severity::info : Severity::warning;
                        told.text = fault.text.empty() ? fmt::format("recording {} was made: {}", info.name, info.why) : fault.text;
                        events_.note(std::move(told));
                    });
    });
}

void WarmRecorder::load_recording(const std::string& name, std::function<void(std::optional<std::string>)> then) {
    if (!kept_.contains(name)) return then(std::nullopt);
    boost::asio::post(disk_, [this, path = path_of(name), then = std::move(then)]() mutable {
        std::optional<std::string> bytes;
        if (std::ifstream in(path, std::ios::binary); in)
            bytes.emplace(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
        threads_.answer([then = std::move(then), bytes = std::move(bytes)]() mutable { then(std::move(bytes)); });
    });
}

void WarmRecorder::rename_recording(const std::string& name, const std::string& to, std::function<void(RecordingFault)> then) {
    using Kind = RecordingFault::Kind;
    if (!kept_.contains(name)) return then({Kind::no_such, ""});
    if (name == to) return then({});
    if (kept_.contains(to)) return then({Kind::exists, fmt::format("there is a recording {} already: choose another name", to)});
    auto node = kept_.extract(name);
    node.key() = node.mapped().name = to;
    node.mapped().automatic = false;  // who names it wants to keep it
    kept_.insert(std::move(node));
    boost::asio::post(disk_, [this, from = path_of(name), into = path_of(to), name, to, then = std::move(then)]() mutable {
        const auto done = files::rename(from, into, settings_.directory);
        threads_.answer([this, name, to, fault = done ? std::string() : done.error().text, then = std::move(then)] {
            if (!fault.empty()) {
                if (auto back = kept_.extract(to); back) back.key() = back.mapped().name = name, kept_.insert(std::move(back));
                return then({Kind::no_room, fault});
            }
            then({});
        });
    });
}

void WarmRecorder::remove_recording(const std::string& name, std::function<void(RecordingFault)> then) {
    if (kept_.erase(name) == 0) return then({RecordingFault::Kind::no_such, ""});
    boost::asio::post(disk_, [this, path = path_of(name), then = std::move(then)]() mutable {
        std::error_code ec;
        (void)fs::remove(path, ec);
        threads_.answer([then = std::move(then)] { then({}); });
    });
}

}  // namespace axisgate
