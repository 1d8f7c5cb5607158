// WarmGateway: commands, the site, values and events as they are now, twins' hands, the Modbus door's report, metrics.
// In: calls, mailboxes. Out: callbacks. At most 1024 commands wait. Never blocks but for a local read of the database.
#include "gateway/runtime/warm_gateway.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/json/serialize.hpp>
#include <fstream>

#include "gateway/runtime/axis_metrics.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/site_file.hpp"
#include "gateway/runtime/site_names.hpp"

namespace axisgate {
namespace {
constexpr std::size_t max_waiting = 1024;  // commands without an answer, all HTTP clients together
constexpr std::size_t sample_ring = 8192;

std::uint64_t live_key(AxisId axis, Point p) noexcept {
    return (std::uint64_t{index_of(axis)} << 32) | (std::uint64_t{p.parameter} << 16) | p.element;
}
AxisId axis_of(std::uint64_t live_key) noexcept { return AxisId{static_cast<std::uint16_t>(live_key >> 32)}; }
}  // namespace

WarmGateway::WarmGateway(boost::asio::io_context& warm, Hot& hot, Cold& cold, Families families, std::unique_ptr<StoreReader> reader)
    : io_(warm),
      hot_(hot),
      cold_(cold),
      families_(std::move(families)),
      reader_(std::move(reader)),
      results_(2 * max_waiting, warm.get_executor(), [this](Result&& r) { answer(std::move(r)); }),
      samples_(sample_ring, warm.get_executor(),
               [this](Sample&& s) { take(std::move(s)); }),
      started_(monotonic_now()) {
    events_.connect(&cold_.from_service());
}

double WarmGateway::uptime_s() const { return seconds(monotonic_now() - started_); }
std::int64_t WarmGateway::now_unix_ns() const { return unix_now_ns(); }
std::int64_t WarmGateway::to_unix_ns(Instant instant) const { return unix_ns_of(instant); }

void WarmGateway::set_site(std::shared_ptr<const SiteState> site) {
    site_ = std::move(site);
    std::erase_if(live_, [this](const auto& entry) { return picture(axis_of(entry.first)).source != entry.second.source; });
    const auto listeners = listeners_;
    for (auto* l : listeners) l->on_site(site_);
}

/// What a former drive of the axis said may still be on its way here when another one speaks for it.
void WarmGateway::take(Sample&& s) {
    if (picture(s.axis).source != s.source) return;
    Said& known = live_[live_key(s.axis, s.point)];
    if (known.source == s.source && known.at > s.at) return;
    const auto listeners = listeners_;
    for (auto* l : listeners) l->on_sample(s);
    known = {{std::move(s.value), unix_ns_of(s.at), s.quality}, s.source, s.at};
}

void WarmGateway::events_written(std::vector<Event> events) {
    boost::asio::post(io_, [this, events = std::move(events)] {
        const auto listeners = listeners_;
        for (const auto& e : events) {
            for (auto* l : listeners) l->on_event(e);
        }
    });
}

std::vector<std::string> WarmGateway::not_ready() const {
    auto list = hot_.reports()->complaints;
    if (!cold_.healthy()) list.push_back("the database cannot be written: see the log for the reason");
    if (more_not_ready) {
        for (auto& s : more_not_ready()) list.push_back(std::move(s));
    }
    return list;
}

AxisPicture WarmGateway::picture(AxisId axis) const {
    const Image& image = hot_.image_for_readers();
    return index_of(axis) < image.size() ? image.cell(axis).read() : AxisPicture{};
}

std::uint64_t WarmGateway::picture_revision(AxisId axis) const {
    const Image& image = hot_.image_for_readers();
    return index_of(axis) < image.size() ? image.cell(axis).revision() : 0;
}

Ticket WarmGateway::submit(Command command, std::function<void(const Result&)> then) {
    const Ticket ticket = make_ticket(first_service_door, next_ticket_++);
    command.ticket = ticket;
    const AxisId axis = command.axis;
    if (waiting_.size() >= max_waiting || !hot_.commands().push(std::move(command))) {
        boost::asio::post(io_, [ticket, axis, then = std::move(then)] {
            Result r;
            r.ticket = ticket;
            r.axis = axis;
            r.outcome = Outcome::refused;
            r.reason = Reason::busy;
            r.text = fmt::format("{} commands wait for their answers already; come again in a moment", max_waiting);
            then(r);
        });
        return ticket;
    }
    waiting_.emplace(ticket, std::move(then));
    hot_.commands().announce();
    return ticket;
}

void WarmGateway::client_lost(const AuthorityClient& who, LossCause cause) {
    // A full ring: the axes' watchdogs see the silence.
    if (hot_.jobs().push([who, cause](Engine& engine, Instant now) { engine.on_client_lost(who, cause, now); })) hot_.jobs().announce();
}

void WarmGateway::answer(Result&& result) {
    const auto it = waiting_.find(result.ticket);
    if (it == waiting_.end()) return;
    const auto then = std::move(it->second);
    waiting_.erase(it);
    then(result);
}

LiveParameter WarmGateway::live(AxisId axis, Point point) const {
    const auto it = live_.find(live_key(axis, point));
    if (it == live_.end()) return {};
    const AxisPicture now = picture(axis);
    if (now.source != it->second.source) return {};
    LiveParameter out = it->second.what;
    // Said once, and nobody is there to say it again.
    if (out.quality == Quality::good && (now.flags & flag_online) == 0) out.quality = Quality::stale;
    return out;
}

std::vector<StoredParameter> WarmGateway::stored(const std::string& axis) const {
    std::vector<StoredParameter> out;
    if (const auto rows = reader_->stored(axis)) out.assign(rows->begin(), rows->end());
    return out;
}

std::vector<StoredParameter> WarmGateway::history(const std::string& axis, const std::string& parameter, std::size_t limit) const {
    std::vector<StoredParameter> out;
    if (const auto rows = reader_->history(axis, parameter, limit)) out.assign(rows->begin(), rows->end());
    return out;
}

std::vector<Event> WarmGateway::events(const EventQuery& query) const {
    auto rows = reader_->events(query);
    return rows ? std::move(*rows) : std::vector<Event>{};
}

/// By way of the hot thread, behind everything that it was asked to note, and then behind everything that it has handed to the cold one.
void WarmGateway::events_settled(std::function<void()> then) {
    const auto back = [this, then] { boost::asio::post(io_, then); };
    auto job = [this, back](Engine&, Instant) { cold_.flush(back); };
    if (!hot_.jobs().push(Hot::Job(std::move(job)))) return back();
    hot_.jobs().announce();
}

LineReport WarmGateway::line_report(LineId line) const {
    const auto r = hot_.reports();
    return index_of(line) < r->lines.size() ? r->lines[index_of(line)] : LineReport{};
}

DriveStatus WarmGateway::drive_status(DriveId drive) const {
    const auto r = hot_.reports();
    return index_of(drive) < r->drives.size() ? r->drives[index_of(drive)] : DriveStatus{};
}

Gateway::Trace WarmGateway::trace(LineId line, std::uint64_t since, std::size_t limit) const {
    Trace out;
    const auto r = hot_.reports();
    const auto log = index_of(line) < r->logs.size() ? r->logs[index_of(line)] : nullptr;
    if (!log) return out;
    auto part = log->read(since, limit, unix_ns_of(time_zero));
    out.missed = part.missed;
    out.next = part.next;
    out.entries = std::move(part.entries);
    return out;
}

void WarmGateway::hand(DriveId drive, std::function<void(std::optional<std::vector<HandItem>>)> then) {
    auto job = [this, drive, then](Engine& engine, Instant) {
        Twin* twin = engine.twin(drive);
        std::optional<std::vector<HandItem>> items;
        if (twin) items = twin->hand();
        boost::asio::post(io_, [then, items = std::move(items)]() mutable { then(std::move(items)); });
    };
    if (!hot_.jobs().push(job)) {
        boost::asio::post(io_, [then] { then(std::nullopt); });
        return;
    }
    hot_.jobs().announce();
}

void WarmGateway::set_hand(DriveId drive, std::vector<std::pair<std::string, Value>> items, Origin origin, std::function<void(std::string)> then) {
    auto job = [this, drive, items = std::move(items), origin = std::move(origin), then](Engine& engine, Instant now) {
        std::string fault = engine.set_hand(drive, items, origin, now);
        boost::asio::post(io_, [then, fault = std::move(fault)]() mutable { then(std::move(fault)); });
    };
    if (!hot_.jobs().push(std::move(job))) {
        boost::asio::post(io_, [then] { then("too much is asked at once; come again in a moment"); });
        return;
    }
    hot_.jobs().announce();
}

// --- Modbus locks ---------------------------------------------------------------------------------------------------

void WarmGateway::modbus_report(std::function<void(std::optional<ModbusReport>)> then) {
    auto job = [this, then](Engine&, Instant) {
        auto report = modbus_on_hot();
        boost::asio::post(io_, [then, report = std::move(report)]() mutable { then(std::move(report)); });
    };
    if (!modbus_on_hot || !hot_.jobs().push(Hot::Job(std::move(job)))) {
        boost::asio::post(io_, [then] { then(std::nullopt); });
        return;
    }
    hot_.jobs().announce();
}

/// Stored first, so that a lock that was seen to be on is on after a restart.
void WarmGateway::set_modbus_read_only(bool on, Origin origin, std::function<void(std::string, bool)> then) {
    if (!modbus_read_only_on_hot) {
        boost::asio::post(io_, [then = std::move(then)] { then("there is no Modbus door: set modbus.bind", false); });
        return;
    }
    cold_.run([this, on, origin = std::move(origin), then = std::move(then)](Store& store) mutable {
        StoreDocument d;
        d.kind = "setting";
        d.name = "modbus.read_only";
        d.text = on ? "true" : "false";
        d.who = origin.text();
        d.at_unix_ns = unix_now_ns();
        const auto saved = store.save_document(d);
        if (!saved) {
            boost::asio::post(io_, [then = std::move(then), fault = saved.error().text] { then(fault, true); });
            return;
        }
        boost::asio::post(io_, [this, on, origin = std::move(origin), then = std::move(then)]() mutable {
            auto job = [this, on, origin = std::move(origin), then](Engine&, Instant now) {
                modbus_read_only_on_hot(on);
                Event e;
                e.kind = "modbus";
                e.severity = on ? Severity::warning : Severity::info;
                e.text = on ? "the Modbus door is read-only now" : "the Modbus door takes writes again";
                e.who = origin.who ? *origin.who : "";
                e.door = std::string(name_of(origin.door));
                hot_.on_event(std::move(e), now);
                boost::asio::post(io_, [then] { then({}, false); });
            };
            if (!hot_.jobs().push(Hot::Job(std::move(job)))) return then("it is stored, but could not be put in force now: send it again", false);
            hot_.jobs().announce();
        });
    });
}

// --- site -----------------------------------------------------------------------------------------------------------

void WarmGateway::finish_site(bool good, std::string fault, std::shared_ptr<const SiteState> state, const std::function<void(SiteAnswer)>& then, bool not_stored) {
    applying_ = false;
    if (good) set_site(std::move(state));
    then({good, std::move(fault), site_, not_stored});
}

void WarmGateway::apply_site(Site site, std::uint64_t expected_revision, Origin origin, std::function<void(SiteAnswer)> then) {
    if (applying_ || (expected_revision != 0 && expected_revision != site_->revision)) {
        const std::string fault = applying_ ? "another change of the site is being put in force; come again in a moment"
                                            : fmt::format("the site has changed meanwhile: it is revision {} now, not {}", site_->revision, expected_revision);
        boost::asio::post(io_, [this, fault, then = std::move(then)] { then({false, fault, site_}); });
        return;
    }
    applying_ = true;
    Event e;
    e.kind = "site";
    e.who = origin.who ? *origin.who : "";
    e.door = std::string(name_of(origin.door));
    for (const auto& d : differences(site_->site, site)) e.text += (e.text.empty() ? "" : "; ") + d;
    if (e.text.empty()) e.text = "saved without a change";
    SiteChange change = names_between(to_json(site_->site), to_json(site));
    if (on_trial_) {
        for (const auto& a : trial_base_.axes) change.kept_axes.push_back(a.name);
        for (const auto& d : trial_base_.drives) change.kept_drives.push_back(d.name);
    }
    cold_.run([this, site = std::move(site), who = origin.text(), change = std::move(change), e = std::move(e), then = std::move(then)](Store& store) mutable {
        for (const auto& known : store.axes().value_or(std::vector<AxisRecord>())) {
            if (known.removed_unix_ns && std::ranges::find(*change.axes, known.name, &SiteAxis::name) != change.axes->end())
                e.text += fmt::format("; axis {} was there before: what was stored for it is shown again", known.name);
        }
        const auto saved = store.save_site(boost::json::serialize(to_json(site)), who, unix_now_ns(), change);
        if (!saved) {
            boost::asio::post(io_, [this, fault = saved.error().text, then = std::move(then)] { finish_site(false, fault, nullptr, then, true); });
            return;
        }
        auto memory = read_site_memory(store, site);
        boost::asio::post(io_, [this, site = std::move(site), memory = std::move(memory), revision = *saved, e = std::move(e), then = std::move(then)]() mutable {
            auto job = [this, site = std::move(site), memory = std::move(memory), revision, e = std::move(e), then](Engine& engine, Instant now) mutable {
                hot_.on_event(std::move(e), now);
                engine.change_site(std::move(site), std::move(memory), revision, now,
                                   [this, then = std::move(then)](std::shared_ptr<const SiteState> state) mutable {
                                       hot_.tell_site(*state);
                                       boost::asio::post(io_, [this, state = std::move(state), then = std::move(then)]() mutable {
                                           finish_site(true, {}, std::move(state), then);
                                       });
                                   });
            };
            if (!hot_.jobs().push(Hot::Job(std::move(job)))) {
                finish_site(false, "the site is stored, but could not be put in force now: restart, or save it again", nullptr, then);
                return;
            }
            hot_.jobs().announce();
        });
    });
}

// --- metrics --------------------------------------------------------------------------------------------------------

std::string WarmGateway::metrics() const {
    std::string s;
    const auto head = [&](std::string_view name, std::string_view type, std::string_view help) {
        s += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name, type);
    };
    head("axisgate_build_info", "gauge", "Version of the program.");
    s += fmt::format("axisgate_build_info{{version=\"{}\"}} 1\n", AXISGATE_VERSION);
    head("axisgate_uptime_seconds", "gauge", "Time since the start.");
    s += fmt::format("axisgate_uptime_seconds {:.3f}\n", uptime_s());
    head("axisgate_mapping_info", "gauge", "Revision of the register mapping (register 18).");
    s += fmt::format("axisgate_mapping_info{{revision=\"{:08x}\"}} 1\n", mapping_revision(site_->site));
    if (std::ifstream statm("/proc/self/statm"); statm) {
        std::uint64_t size = 0, resident = 0;
        statm >> size >> resident;
        head("axisgate_resident_memory_bytes", "gauge", "Resident memory of the process.");
        s += fmt::format("axisgate_resident_memory_bytes {}\n", resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)));
    }
    head("axisgate_hot_turns_total", "counter", "Turns of the hot loop.");
    s += fmt::format("axisgate_hot_turns_total {}\n", hot_.turns());
    head("axisgate_store_batches_total", "counter", "Transactions written to the database.");
    s += fmt::format("axisgate_store_batches_total {}\n", cold_.batches());
    head("axisgate_store_write_seconds_total", "counter", "Time spent writing to the database.");
    s += fmt::format("axisgate_store_write_seconds_total {:.6f}\n", static_cast<double>(cold_.write_ns()) * 1e-9);
    head("axisgate_store_faults_total", "counter", "Transactions that could not be written.");
    s += fmt::format("axisgate_store_faults_total {}\n", cold_.faults());
    head("axisgate_lost_events_total", "counter", "Events that found their queue full.");
    s += fmt::format("axisgate_lost_events_total {}\n", hot_.lost_events() + events_.lost());

    const auto reports = hot_.reports();
    head("axisgate_fail_safe_total", "counter", "Axes that were stopped because the client that commanded them was lost, by cause.");
    for (const LossCause cause : loss_causes)
        s += fmt::format("axisgate_fail_safe_total{{cause=\"{}\"}} {}\n", name_of(cause), reports->losses[static_cast<std::size_t>(cause)]);
    const auto& site = *site_;
    const auto per_line = [&](std::string_view name, std::string_view type, std::string_view help, auto&& value) {
        head(name, type, help);
        for (std::size_t i = 0; i < site.line_ids.size(); ++i) {
            const auto id = index_of(site.line_ids[i]);
            if (id < reports->lines.size()) s += fmt::format("{}{{line=\"{}\"}} {}\n", name, site.site.lines[i].name, value(reports->lines[id]));
        }
    };
    per_line("axisgate_line_up", "gauge", "1: the line can carry frames.", [](const LineReport& r) { return r.status.state == LineStatus::State::up ? 1 : 0; });
    per_line("axisgate_line_frames_received_total", "counter", "Frames or runs of bytes that arrived.", [](const LineReport& r) { return r.status.frames_in; });
    per_line("axisgate_line_frames_sent_total", "counter", "Frames or runs of bytes that left.", [](const LineReport& r) { return r.status.frames_out; });
    per_line("axisgate_line_dropped_total", "counter", "Frames that found the send queue full.", [](const LineReport& r) { return r.status.dropped; });
    per_line("axisgate_line_errors_total", "counter", "Errors of the line or its controller.", [](const LineReport& r) { return r.status.errors; });
    per_line("axisgate_line_reopened_total", "counter", "Times the line came back.", [](const LineReport& r) { return r.status.reopened; });
    per_line("axisgate_line_load_ratio", "gauge", "Share of the bit rate in use.", [](const LineReport& r) { return fmt::format("{:.4f}", r.status.load); });
    per_line("axisgate_line_exchanges_total", "counter", "Requests that got their answer.", [](const LineReport& r) { return r.counters.exchanges; });
    per_line("axisgate_line_timeouts_total", "counter", "Requests without an answer.", [](const LineReport& r) { return r.counters.timeouts; });
    per_line("axisgate_line_retries_total", "counter", "Requests sent again.", [](const LineReport& r) { return r.counters.retries; });
    per_line("axisgate_line_refused_total", "counter", "Requests that a drive refused.", [](const LineReport& r) { return r.counters.refused; });
    per_line("axisgate_line_garbled_total", "counter", "Frames or bytes that were not the protocol.", [](const LineReport& r) { return r.counters.garbled; });
    per_line("axisgate_line_unexpected_total", "counter", "Well formed frames that nobody had asked for.", [](const LineReport& r) { return r.counters.unexpected; });

    const auto per_drive = [&](std::string_view name, std::string_view help, auto&& value) {
        head(name, "gauge", help);
        for (std::size_t i = 0; i < site.drive_ids.size(); ++i) {
            s += fmt::format("{}{{drive=\"{}\"}} {}\n", name, site.site.drives[i].name, value(drive_status(site.drive_ids[i])));
        }
    };
    per_drive("axisgate_drive_online", "1: the drive or its twin answers.", [](const DriveStatus& d) { return d.presence != Presence::offline ? 1 : 0; });
    per_drive("axisgate_drive_simulated", "1: the embedded twin serves the axes.", [](const DriveStatus& d) { return d.presence == Presence::twin ? 1 : 0; });
    std::vector<AxisPicture> pictures;
    pictures.reserve(site.axis_ids.size());
    for (const AxisId id : site.axis_ids) pictures.push_back(picture(id));
    s += axis_metrics(site, pictures, monotonic_now());
    if (more_metrics) s += more_metrics();
    return s;
}

}  // namespace axisgate
