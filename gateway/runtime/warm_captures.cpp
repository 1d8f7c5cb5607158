// Fast captures: armed, running, being written. Files are never written by the service thread.
#include "gateway/runtime/warm_captures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>

#include "gateway/runtime/clock.hpp"
#include "gateway/services/recorder/axr.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

std::string packed(const CaptureInfo& info, const json::array& columns) {
    AxrWriter w;
    w.begin(axr_meta);
    w.add(json::serialize(json::object{{"at_unix_ns", info.at_unix_ns}, {"version", AXISGATE_VERSION}, {"summary", info.summary}}));
    w.begin(axr_capture);
    w.add(json::serialize(columns));
    return w.finish();
}

CaptureInfo known_of(const std::string& path, std::string name) {
    CaptureInfo i;
    i.name = std::move(name);
    std::error_code ec;
    i.bytes = std::filesystem::file_size(path, ec);
    const std::string head = read_beginning(path);
    const auto text = axr_head(head, i.fault);
    boost::system::error_code unread;
    const auto meta = i.fault.empty() ? json::parse(text, unread) : json::value();
    const auto* o = meta.if_object();
    const auto* summary = o ? o->if_contains("summary") : nullptr;
    if (!summary || !summary->is_object()) {
        if (i.fault.empty()) i.fault = "what it says of itself cannot be read";
        return i;
    }
    i.summary = summary->get_object();
    const auto* at = o->if_contains("at_unix_ns");
    i.at_unix_ns = at && at->is_int64() ? at->get_int64() : 0;
    return i;
}

/// True for commands that move an axis, or may.
bool may_move(const CommandBody& body) {
    return std::holds_alternative<Move>(body) || std::holds_alternative<Home>(body) || std::holds_alternative<StartTogether>(body) ||
           std::holds_alternative<ProcessData>(body) || std::holds_alternative<Action>(body);
}
}  // namespace

WarmCaptures::~WarmCaptures() {
    recorder_.listen(nullptr);
    recorder_.end_disk();
}

void WarmCaptures::begin(const RecorderSettings& settings) {
    bound_ = settings.captures_bytes;
    shelf_.open(settings.captures, known_of);
    recorder_.listen(this);
}

std::shared_ptr<WarmCaptures::Running> WarmCaptures::running(const std::string& name) const {
    const auto it = std::ranges::find_if(running_, [&](const auto& r) { return r->order.name == name; });
    return it == running_.end() ? nullptr : *it;
}

CaptureInfo WarmCaptures::info_of(const Running& r) {
    CaptureInfo i;
    i.name = r.order.name;
    const std::int64_t offset = unix_ns_of(at_ns(0));
    i.at_unix_ns = ns_of(r.capture.triggered_at().value_or(r.capture.armed_at())) + offset;
    i.summary = capture_summary(r.order, r.capture, offset);
    return i;
}

std::vector<CaptureInfo> WarmCaptures::captures() {
    recorder_.look();
    std::vector<CaptureInfo> out;
    for (const auto& r : running_)
        out.push_back(info_of(*r));
    for (auto& i : shelf_.newest_first())
        out.push_back(std::move(i));
    return out;
}

void WarmCaptures::arm(CaptureOrder order, std::function<void(RecordingFault, CaptureInfo)> then) {
    std::erase_if(running_, [&](const auto& r) { return r->capture.state() == Capture::State::cancelled && r->order.name == order.name; });
    if (shelf_.kept().contains(order.name) || running(order.name)) return then(shelf_.exists(order.name), {});
    std::size_t busy = 0;
    for (const auto& r : running_) {
        if (r->capture.over()) continue;
        ++busy;
        if (r->order.line == order.line)
            return then({RecordingFault::Kind::busy,
                         fmt::format("the capture {} runs on line {}: wait for its end, or delete it", r->order.name, order.line)},
                        {});
    }
    if (busy >= most_running)
        return then({RecordingFault::Kind::busy, fmt::format("{} captures run already: wait for the end of one, or delete it", busy)}, {});
    if (shelf_.full(bound_))
        return then({RecordingFault::Kind::no_room,
                     fmt::format("{} captures take {} kB of {} kB: delete some", shelf_.kept().size(), shelf_.bytes() >> 10, bound_ >> 10)},
                    {});
    const Instant now = monotonic_now();
    const CaptureWish wish = order.wish;
    auto r = std::make_shared<Running>(Running{std::move(order), Capture(wish, now)});
    running_.push_front(r);
    forget_oldest();
    const Instant until = now + wish.wait + wish.before + wish.after + 2 * records_late;
    auto job = [this, r, axes = wish.axes, period = wish.period, until, then](Engine& engine, Instant at) {
        auto fault = engine.look_closely(axes, period, until, at);
        threads_.answer([this, r, then, fault = std::move(fault)] {
            if (fault.empty()) return then({}, info_of(*r));
            std::erase(running_, r);
            then({RecordingFault::Kind::busy, fault}, {});
        });
    };
    if (threads_.on_hot(std::move(job))) return;
    std::erase(running_, r);
    then({RecordingFault::Kind::busy, too_much_asked}, {});
}

/// Captures that were given up are shown for a while, in a limited number.
void WarmCaptures::forget_oldest() {
    std::size_t given_up = 0;
    std::erase_if(running_, [&](const auto& r) { return r->capture.state() == Capture::State::cancelled && ++given_up > most_given_up; });
}

void WarmCaptures::on_picture(AxisId axis, const PictureRecord& picture, Instant at) {
    for (const auto& r : running_)
        r->capture.on_picture(axis, picture, at);
}

void WarmCaptures::on_command(const Command& command, Instant at) {
    if (!may_move(command.body)) return;
    for (const auto& r : running_)
        r->capture.on_command(command.axis, at);
}

void WarmCaptures::on_time(Instant now) {
    const auto all = running_;  // a finished capture leaves the list
    for (const auto& r : all) {
        r->capture.on_time(now, records_late);
        if (r->capture.over() && !r->ended) end(*r);
        if (r->capture.state() == Capture::State::done && !r->written && !shelf_.writing()) keep(r);
    }
}

/// The line returns to its own poll period. If the hot thread is too busy to accept this, the fast polling ends by itself.
void WarmCaptures::end(Running& r) {
    r.ended = true;
    (void)threads_.on_hot([axes = r.order.wish.axes](Engine& engine, Instant now) { (void)engine.look_closely(axes, {}, {}, now); });
}

void WarmCaptures::keep(const std::shared_ptr<Running>& r) {
    r->written = true;
    const CaptureInfo info = info_of(*r);
    shelf_.write(
        info, [info, r] { return packed(info, capture_columns(r->order, r->capture)); },
        [this, r](const RecordingFault& fault, const CaptureInfo& kept) {
            if (fault.kind != RecordingFault::Kind::none) {
                r->capture.lose(fault.text);
            } else {
                std::erase(running_, r);
            }
            Event e;
            e.kind = "capture";
            e.severity = fault.kind == RecordingFault::Kind::none ? Severity::info : Severity::warning;
            e.text = fault.kind == RecordingFault::Kind::none ? fmt::format("capture {} is done, {} rows", kept.name, r->capture.rows())
                                                              : fmt::format("capture {}: {}", kept.name, fault.text);
            e.who = r->order.who;
            events_.note(std::move(e));
        });
}

void WarmCaptures::load_capture(const std::string& name, std::function<void(RecordingFault, json::array)> then) {
    if (const auto r = running(name)) return then({}, capture_columns(r->order, r->capture));
    const auto kept = shelf_.kept().find(name);
    if (kept == shelf_.kept().end()) return then({RecordingFault::Kind::no_such, ""}, {});
    shelf_.load(name, [then = std::move(then)](const std::optional<std::string>& bytes) {
        if (!bytes) return then({RecordingFault::Kind::no_such, ""}, {});
        const Axr axr = read_axr(*bytes);
        if (!axr.fault.empty()) return then({RecordingFault::Kind::damaged, axr.fault}, {});
        const auto text = axr.section(axr_capture);
        boost::system::error_code ec;
        auto columns = json::parse({text.data(), text.size()}, ec);
        if (ec || !columns.is_array()) return then({RecordingFault::Kind::damaged, "its columns cannot be read"}, {});
        then({}, std::move(columns.get_array()));
    });
}

void WarmCaptures::rename_capture(const std::string& name, const std::string& to, std::function<void(RecordingFault)> then) {
    const auto r = running(name);
    if (name != to && (running(to) || shelf_.kept().contains(to))) return then(shelf_.exists(to));
    if (r && r->written) return then({RecordingFault::Kind::busy, "it is being written: try again"});
    if (r) {
        r->order.name = to;
        return then({});
    }
    shelf_.rename(
        name, to, [&](CaptureInfo& i) { i.summary["name"] = to; }, std::move(then));
}

void WarmCaptures::remove_capture(const std::string& name, std::function<void(RecordingFault)> then) {
    const auto r = running(name);
    if (!r) return shelf_.remove(name, std::move(then));
    if (r->written && r->capture.state() == Capture::State::done)
        return then({RecordingFault::Kind::busy, "it is being written: try again"});
    r->capture.cancel("cancelled");
    if (!r->ended) end(*r);
    std::erase(running_, r);
    then({});
}

}  // namespace axisgate
