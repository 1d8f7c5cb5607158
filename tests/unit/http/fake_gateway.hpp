// A Gateway for tests of the HTTP door: a small site, a made-up family, and answers that the test gives when it wants.
// In: what the test sets. Out: what the door asked. Never has a thread or a clock: now_ns is set by the test.
#pragma once

#include <boost/json/parse.hpp>

#include <deque>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "gateway/services/gateway.hpp"

namespace axisgate::http::test {

inline constexpr std::string_view catalogue_text = R"({
  "family": "demo", "number": 7, "title": "Demo drive", "channels": {"max": 2},
  "parameters": [
    {"id": "AC", "name": "acceleration", "group": "motion", "type": "u32", "unit": "pulse/s^2", "min": 1, "max": 65000000, "default": 20000,
     "access": "RW", "storage": "eeprom", "description": "Acceleration of motions."},
    {"id": "ML", "name": "model", "group": "identity", "type": "text", "access": "R", "description": "Model name."},
    {"id": "KEY", "name": "unlock", "group": "identity", "type": "u16", "access": "W", "description": "Opens what is locked."},
    {"id": "MT", "name": "micro_steps", "group": "motor", "type": "u8", "allowed": {"1": "full", "16": "sixteenth"}, "default": 16,
     "access": "RW", "description": "Steps."},
    {"id": "PP", "name": "protocol", "group": "bus", "type": "u8", "min": 0, "max": 200, "access": "RW", "description": "Array.", "first": 1, "count": 8, "addressing": true},
    {"id": "N", "name": "registers", "group": "program", "type": "f64", "access": "RW", "description": "Long array.", "first": 1, "count": 2000}
  ],
  "commands": [{"id": "BG", "name": "begin", "description": "Starts."},
    {"id": "GO", "name": "go", "arguments": [{"name": "position", "type": "i32", "unit": "mm", "scale": 0.0001}, {"name": "speed", "type": "u16", "default": 5}]}],
  "errors": [{"code": 49, "kind": "error", "name": "overcurrent", "text": "too much current", "cause": "short", "remedy": "look"}]
})";

inline std::string check_demo_address(std::string_view address) {
    return address.find_first_not_of("0123456789") == std::string_view::npos && !address.empty() ? "" : "an address is a number";
}

/// Reads a frame as its number since the decoder was made, so that a test sees whether it was made anew.
struct DemoDecoder final : Decoder {
    int n = 0;
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) override {
        return {std::string(to_drive.value_or(false) ? "to" : "from") + " the drive, frame " + std::to_string(++n) + " of " +
                std::to_string(frame.data().size()) + " bytes"};
    }
    std::vector<std::string> finish() override { return {}; }
};
inline std::unique_ptr<Decoder> make_demo_decoder(const Catalogue&, LineKind) { return std::make_unique<DemoDecoder>(); }

class FakeGateway final : public Gateway {
public:
    explicit FakeGateway(std::string_view site_text = default_site);
    ~FakeGateway() override;  ///< in fake_gateway.cpp, and with it the table of virtual functions: it is compiled once

    static constexpr std::string_view default_site = R"({
      "lines": [{"name": "can0", "uri": "twin", "family": "demo", "bitrate": 1000000}, {"name": "can1", "uri": "twin", "family": "demo"}],
      "drives": [{"name": "feeder", "line": "can0", "address": 5}, {"name": "slide", "line": "can0", "address": 6}, {"name": "bare", "line": "can1", "address": 7}],
      "axes": [{"name": "feeder", "drive": "feeder", "number": 1, "unit": "mm", "increments_per_unit": 3200},
               {"name": "slide", "drive": "slide", "number": 2, "increments_per_unit": 1}],
      "mappings": [{"unit": 2, "table": "holding", "address": 0, "point": "slide.position", "type": "i32"}] })";

    /// Puts a site in force as if it had been applied; ids stay with the names.
    void put_site(std::string_view text);
    void put_site(Site site);
    [[nodiscard]] AxisId axis(const std::string& name) { return AxisId{id_of("axis " + name)}; }
    [[nodiscard]] DriveId drive(const std::string& name) { return DriveId{id_of("drive " + name)}; }
    [[nodiscard]] LineId line(const std::string& name) { return LineId{id_of("line " + name)}; }

    void set_picture(const std::string& name, AxisPicture p) {
        pictures[axis(name)] = p;
        ++revisions[axis(name)];
    }
    void tell(Event e) {
        e.id = ++last_event;
        if (e.at_unix_ns == 0) e.at_unix_ns = now_ns;
        events_.push_back(e);
        const auto all = listeners;
        for (auto* l : all)
            l->on_event(e);
    }
    /// Answers the oldest command that waits.
    void finish(Result r) {
        if (waiting.empty()) throw std::logic_error("no command waits");
        auto w = std::move(waiting.front());
        waiting.pop_front();
        r.ticket = w.ticket;
        r.axis = w.command.axis;
        w.then(r);
    }

    // --- what the test sets and reads ----------------------------------------------------------------------------------
    Catalogue catalogue;
    Family family{};
    std::int64_t now_ns = 1'767'323'045'678'901'234;  // 2026-01-02T03:04:05.678901234Z
    std::vector<std::string> missing;
    std::map<AxisId, AxisPicture> pictures;
    std::map<AxisId, std::uint64_t> revisions;
    std::map<std::pair<AxisId, Point>, LiveParameter> live_values;
    std::map<std::string, std::vector<StoredParameter>> stored_values;
    std::map<DriveId, DriveStatus> drive_states;
    std::map<LineId, LineReport> line_states;
    std::map<LineId, std::vector<TraceEntry>> traces;
    std::map<DriveId, std::vector<HandItem>> hands;
    std::string hand_fault;
    std::vector<Event> events_;
    mutable std::vector<EventQuery> event_queries;
    std::uint64_t last_event = 0;
    std::vector<SetPoint> set_points;
    std::vector<std::pair<AuthorityClient, LossCause>> lost;
    std::set<GatewayListener*> listeners;
    mutable int pictures_read = 0;

    struct Waiting {
        Ticket ticket;
        Command command;
        std::function<void(const Result&)> then;
    };
    std::deque<Waiting> waiting;
    std::vector<Command> submitted;
    /// Set: commands are answered inside submit.
    std::function<Result(const Command&)> at_once;
    Ticket last_ticket = (std::uint64_t{3} << 56) + 16;

    enum class Apply { now, later, fail, overtake_once, overtake_always } apply = Apply::now;
    std::vector<std::pair<Site, std::uint64_t>> applied;  ///< with the expected revision
    std::function<void()> apply_waiting;

    // --- Gateway -------------------------------------------------------------------------------------------------------
    std::vector<DoorInfo> doors() const override { return {{"http", "127.0.0.1:8080"}, {"modbus", "127.0.0.1:1502"}}; }
    double uptime_s() const override { return 12.5; }
    std::int64_t now_unix_ns() const override { return now_ns; }
    std::int64_t to_unix_ns(Instant i) const override { return 1'767'323'045'000'000'000 + ns_of(i); }
    const Families& families() const override { return families_; }
    std::vector<std::string> not_ready() const override { return missing; }
    std::string metrics() const override { return "# HELP axisgate_up 1\n# TYPE axisgate_up gauge\naxisgate_up 1\n"; }
    std::shared_ptr<const SiteState> site() const override { return site_; }

    void apply_site(Site site, std::uint64_t expected, Origin, std::function<void(SiteAnswer)> then) override {
        applied.emplace_back(site, expected);
        if (apply == Apply::fail) return then({false, "the disk is full", site_});
        if (apply == Apply::overtake_once || apply == Apply::overtake_always) {
            if (apply == Apply::overtake_once) apply = Apply::now;
            put_site(Site(site_->site));  // somebody else was faster
            return then({false, "the site has another revision", site_});
        }
        auto go = [this, site = std::move(site), then]() mutable {
            put_site(std::move(site));
            then({true, "", site_});
        };
        if (apply == Apply::later) {
            apply_waiting = std::move(go);
        } else {
            go();
        }
    }

    AxisPicture picture(AxisId id) const override {
        ++pictures_read;
        const auto it = pictures.find(id);
        return it == pictures.end() ? AxisPicture{} : it->second;
    }
    std::uint64_t picture_revision(AxisId id) const override {
        const auto it = revisions.find(id);
        return it == revisions.end() ? 0 : it->second;
    }
    void set_point(SetPoint p) override { set_points.push_back(std::move(p)); }
    void client_lost(const AuthorityClient& who, LossCause cause) override { lost.emplace_back(who, cause); }
    Ticket submit(Command command, std::function<void(const Result&)> then) override {
        command.ticket = ++last_ticket;
        submitted.push_back(command);
        if (at_once) {
            Result r = at_once(command);
            r.ticket = command.ticket;
            then(r);
        } else {
            waiting.push_back({command.ticket, command, std::move(then)});
        }
        return command.ticket;
    }
    LiveParameter live(AxisId id, Point p) const override {
        const auto it = live_values.find({id, p});
        return it == live_values.end() ? LiveParameter{} : it->second;
    }
    std::vector<StoredParameter> stored(const std::string& name) const override {
        const auto it = stored_values.find(name);
        return it == stored_values.end() ? std::vector<StoredParameter>{} : it->second;
    }
    std::vector<StoredParameter> history(const std::string& name, const std::string& parameter, std::size_t limit) const override {
        std::vector<StoredParameter> out;
        for (const auto& s : stored(name)) {
            if (s.parameter == parameter && out.size() < limit) out.push_back(s);
        }
        return out;
    }
    LineReport line_report(LineId id) const override {
        const auto it = line_states.find(id);
        return it == line_states.end() ? LineReport{} : it->second;
    }
    DriveStatus drive_status(DriveId id) const override {
        const auto it = drive_states.find(id);
        return it == drive_states.end() ? DriveStatus{} : it->second;
    }
    Trace trace(LineId id, std::uint64_t since, std::size_t limit) const override {
        Trace t;
        t.next = std::max<std::uint64_t>(since, 1);
        const auto it = traces.find(id);
        if (it == traces.end() || it->second.empty()) return t;
        const std::uint64_t oldest = it->second.front().sequence;
        if (since < oldest) t.missed = oldest - std::max<std::uint64_t>(since, 1);
        for (const auto& e : it->second) {
            if (e.sequence < since || t.entries.size() >= limit) continue;
            t.entries.push_back(e);
            t.next = e.sequence + 1;
        }
        return t;
    }
    void hand(DriveId id, std::function<void(std::optional<std::vector<HandItem>>)> then) override {
        const auto it = hands.find(id);
        then(it == hands.end() ? std::nullopt : std::optional(it->second));
    }
    void set_hand(DriveId id, std::vector<std::pair<std::string, Value>> items, Origin, std::function<void(std::string)> then) override {
        if (!hand_fault.empty()) return then(hand_fault);
        for (const auto& [k, v] : items) {
            for (auto& h : hands[id]) {
                if (h.name == k) h.value = v;
            }
        }
        then("");
    }
    std::vector<Event> events(const EventQuery& query) const override {
        event_queries.push_back(query);
        std::vector<Event> out;
        for (const auto& e : events_) {
            if (e.id > query.since_id && e.at_unix_ns >= query.since_unix_ns && (query.axis.empty() || e.axis == query.axis) &&
                (!query.at_least || e.severity >= *query.at_least) && (query.kind.empty() || e.kind == query.kind) &&
                (query.before_id == 0 || e.id < query.before_id)) {
                out.push_back(e);
            }
        }
        const auto over = static_cast<std::ptrdiff_t>(out.size()) - static_cast<std::ptrdiff_t>(query.limit);
        if (over > 0 && query.oldest_first) out.erase(out.end() - over, out.end());
        if (over > 0 && !query.oldest_first) out.erase(out.begin(), out.begin() + over);
        return out;
    }
    void listen(GatewayListener* l) override { listeners.insert(l); }
    void unlisten(GatewayListener* l) override { listeners.erase(l); }
    void start_scan(LineId line, ScanWish wish, Origin, std::function<void(std::string)> then) override {
        scan_wishes.push_back(std::move(wish));
        if (scan_fault.empty()) scans[line].state = ScanReport::State::running;
        then(scan_fault);
    }
    void cancel_scan(LineId line, std::function<void(ScanReport)> then) override {
        if (scans[line].state == ScanReport::State::running) scans[line].state = ScanReport::State::cancelled;
        then(scans[line]);
    }
    void scan_report(LineId line, std::function<void(ScanReport)> then) override { then(scans[line]); }
    std::vector<ScanWish> scan_wishes;
    std::map<LineId, ScanReport> scans;
    std::string scan_fault;
    void note(Event e) override { noted.push_back(std::move(e)); }
    std::vector<Document> documents(const std::string& kind) const override {
        std::vector<Document> out;
        for (const auto& [key, d] : stored_documents) {
            if (key.first == kind) out.push_back(d);
        }
        return out;
    }
    std::optional<Document> document(const std::string& kind, const std::string& name) const override {
        const auto it = stored_documents.find({kind, name});
        return it == stored_documents.end() ? std::nullopt : std::optional(it->second);
    }
    void save_document(const std::string& kind, Document d, std::function<void(std::string)> then) override {
        if (!document_fault.empty()) return then(document_fault);
        ++document_saves;
        on_disk([this, kind, d = std::move(d), then] {
            stored_documents[{kind, d.name}] = d;
            then("");
        });
    }
    void delete_document(const std::string& kind, const std::string& name, std::function<void(std::string)> then) override {
        on_disk([this, kind, name, then] { then(stored_documents.erase({kind, name}) == 0 ? "there is none of this name" : ""); });
    }
    /// Changes of documents wait, in their order, until catch_up().
    bool disk_is_behind = false;
    std::deque<std::function<void()>> disk;
    std::size_t document_saves = 0;
    void on_disk(std::function<void()> job) {
        disk.push_back(std::move(job));
        if (!disk_is_behind) catch_up();
    }
    void catch_up() {
        disk_is_behind = false;
        while (!disk.empty()) {
            const auto job = std::move(disk.front());
            disk.pop_front();
            job();
        }
    }
    std::vector<Event> noted;
    std::map<std::pair<std::string, std::string>, Document> stored_documents;
    std::string document_fault;

    // --- what is kept and staged
    std::map<std::string, std::vector<AxisSnapshot>> kept_snapshots;
    std::string keep_fault;
    std::map<std::uint64_t, SiteRevision> kept_sites;
    SiteStage stage;
    std::optional<registers::RegisterRead> registers_answer;
    std::tuple<std::uint8_t, registers::Table, std::uint16_t, std::uint16_t> registers_asked;
    std::string restored;
    std::vector<SnapshotInfo> snapshots(const std::string& name) const override {
        const auto it = kept_snapshots.find(name);
        return it == kept_snapshots.end() ? std::vector<SnapshotInfo>{} : std::vector<SnapshotInfo>(it->second.begin(), it->second.end());
    }
    std::optional<AxisSnapshot> snapshot(const std::string& name, std::uint32_t n) const override {
        if (const auto it = kept_snapshots.find(name); it != kept_snapshots.end()) {
            for (const auto& s : it->second) {
                if (s.n == n) return s;
            }
        }
        return std::nullopt;
    }
    void save_snapshot(AxisSnapshot s, std::string name, std::function<void(std::uint32_t, std::string)> then) override {
        if (!keep_fault.empty()) return then(0, keep_fault);
        s.n = static_cast<std::uint32_t>(kept_snapshots[name].size() + 1);
        kept_snapshots[name].push_back(s);
        then(s.n, "");
    }
    void delete_snapshot(std::string name, std::uint32_t n, std::function<void(std::string)> then) override {
        std::erase_if(kept_snapshots[name], [n](const auto& s) { return s.n == n; });
        then("");
    }
    std::vector<SiteRevision> site_history(std::size_t limit, std::uint64_t before) const override {
        std::vector<SiteRevision> out;
        for (auto it = kept_sites.rbegin(); it != kept_sites.rend() && out.size() < limit; ++it) {
            if (before == 0 || it->first < before) out.push_back(it->second);
        }
        return out;
    }
    std::optional<SiteRevision> site_revision(std::uint64_t n) const override {
        const auto it = kept_sites.find(n);
        return it == kept_sites.end() ? std::nullopt : std::optional(it->second);
    }
    const SiteStage& site_stage() const override { return stage; }
    std::string stage_site(Site s, std::uint64_t base, const Origin& o) override {
        return stage.stage(std::move(s), base, o.who ? *o.who : "");
    }
    std::string discard_stage() override { return stage.discard(); }
    void apply_stage(std::uint32_t within, Origin o, std::function<void(SiteAnswer)> then) override {
        if (auto fault = stage.begin_apply(site_->revision, within, now_ns, *o.who); !fault.empty()) return then({false, fault, site_});
        before_trial = site_->site;
        put_site(Site(stage.site()));
        stage.applied(true);
        then({true, "", site_});
    }
    std::string confirmed_by;
    void confirm_stage(Origin o, std::function<void(std::string)> then) override {
        if (auto fault = stage.check_confirm(*o.who, now_ns); !fault.empty()) return then(fault);
        confirmed_by = *o.who;
        stage.confirmed();
        then("");
    }
    void roll_back_stage(Origin, std::function<void(SiteAnswer)> then) override {
        if (auto fault = stage.begin_roll_back(); !fault.empty()) return then({false, fault, site_});
        put_site(Site(before_trial));
        stage.rolled_back(true, 0);
        then({true, "", site_});
    }
    void read_registers(std::uint8_t unit, registers::Table table, std::uint16_t address, std::uint16_t count,
                        std::function<void(std::optional<registers::RegisterRead>)> then) override {
        registers_asked = {unit, table, address, count};
        then(registers_answer);
    }
    std::optional<ModbusReport> modbus_door;
    void modbus_report(std::function<void(std::optional<ModbusReport>)> then) override { then(modbus_door); }
    void set_modbus_read_only(bool on, Origin, std::function<void(std::string, bool)> then) override {
        if (!modbus_door) return then("there is no Modbus door", false);
        if (!keep_fault.empty()) return then(keep_fault, true);
        modbus_door->read_only = on;
        then("", false);
    }
    void backup(std::function<void(std::optional<std::string>, std::string)> then) override { then("SQLite", ""); }
    void restore(std::string bytes, Origin, std::function<void(RestoreFault)> then) override {
        restored = std::move(bytes);
        then({keep_fault, no_room});
    }
    std::optional<WaitingBackup> waits;
    bool no_room = false;
    void waiting_backup(std::function<void(std::optional<WaitingBackup>)> then) override { then(waits); }
    void cancel_restore(Origin, std::function<void(std::string)> then) override {
        then(waits ? "" : "none");
        waits.reset();
    }
    Site before_trial;

private:
    std::uint16_t id_of(const std::string& name) { return ids_.emplace(name, static_cast<std::uint16_t>(ids_.size())).first->second; }

    Families families_;
    std::shared_ptr<const SiteState> site_;
    std::map<std::string, std::uint16_t> ids_;
};

inline Event event(std::string text, std::string axis = {}, Severity severity = Severity::info, std::string kind = "note") {
    Event e;
    e.severity = severity;
    e.kind = std::move(kind);
    e.axis = std::move(axis);
    e.text = std::move(text);
    return e;
}

inline AxisSpec axis_spec(std::string name, std::string drive, int number, int channel = 1) {
    AxisSpec a;
    a.name = std::move(name);
    a.drive = std::move(drive);
    a.number = number;
    a.channel = channel;
    return a;
}

/// A picture as an enabled, referenced axis at rest shows it.
inline AxisPicture standing(std::int64_t position, std::int64_t at_ms = 600) {
    AxisPicture p;
    p.number = 1;
    p.family_number = 7;
    p.position = position;
    p.position_demand = position;
    p.demand_source = DemandSource::drive;
    p.statusword = 0x9637;  // operation enabled, simulated, remote, target reached, set-point acknowledged, referenced
    p.mode_display = 1;
    p.flags = flag_online | flag_simulated | flag_referenced | flag_target_reached;
    p.presence = Presence::twin;
    p.target_position = static_cast<std::int32_t>(position);
    p.authority = Door::http;
    p.setpoints_accepted = 3;
    p.native_status = 0x1234;
    p.ever_seen = true;
    p.at = at_ns(at_ms * 1'000'000);
    return p;
}

}  // namespace axisgate::http::test
