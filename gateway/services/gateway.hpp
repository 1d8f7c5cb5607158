// Gateway: what doors on the warm thread (HTTP, WebSocket, later DDS) see of everything else.
// In: commands, wanted site, queries. Out: results through callbacks on the warm executor, pictures, events, traces.
// Never blocks for longer than a local database read; everything that needs the hot thread answers through a callback.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/core/event.hpp"
#include "gateway/core/records.hpp"
#include "gateway/engine/report.hpp"
#include "gateway/site/site_state.hpp"
#include "gateway/axis/authority.hpp"
#include "gateway/axis/image.hpp"
#include "gateway/core/line.hpp"
#include "gateway/registers/unit_map.hpp"
#include "gateway/core/sample.hpp"
#include "gateway/core/scan.hpp"
#include "gateway/site/fail_safe.hpp"
#include "gateway/site/site.hpp"
#include "gateway/site/site_stage.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate {

/// What a subscriber is told, on the warm executor.
struct GatewayListener {
    virtual void on_event(const Event& event) = 0;
    /// The site has changed: names and ids must be looked up anew.
    virtual void on_site(const std::shared_ptr<const SiteState>& site) = 0;
    /// A drive has told a parameter's value, asked for or not.
    virtual void on_sample(const Sample& /*sample*/) {}
    virtual ~GatewayListener() = default;
};

struct NativeReply {  // kept apart from Result so that its shape is the contract's
    Result result;
    std::int64_t took_ms = 0;
};

class Gateway {
public:
    virtual ~Gateway() = default;

    // --- about ---------------------------------------------------------------------------------------------------------
    struct DoorInfo {
        std::string name;     ///< "http", "modbus", ...
        std::string address;  ///< "127.0.0.1:1502"
    };
    [[nodiscard]] virtual std::vector<DoorInfo> doors() const = 0;
    [[nodiscard]] virtual double uptime_s() const = 0;
    [[nodiscard]] virtual std::int64_t now_unix_ns() const = 0;
    /// Converts an instant of a picture to wall-clock time.
    [[nodiscard]] virtual std::int64_t to_unix_ns(Instant instant) const = 0;
    [[nodiscard]] virtual const Families& families() const = 0;
    /// Not ready: what is missing, one sentence each; empty: ready.
    [[nodiscard]] virtual std::vector<std::string> not_ready() const = 0;
    /// Prometheus text of everything but the asking door's own counters.
    [[nodiscard]] virtual std::string metrics() const = 0;

    // --- site ----------------------------------------------------------------------------------------------------------
    [[nodiscard]] virtual std::shared_ptr<const SiteState> site() const = 0;
    struct SiteAnswer {
        bool good = false;
        std::string fault;                     ///< why it could not be stored or applied
        std::shared_ptr<const SiteState> now;  ///< the site in force after it
        bool not_stored = false;               ///< the database could not keep it
    };
    /// Puts a checked site in force: stored first, then applied without a restart; only what changed is disturbed.
    /// `expected_revision`: refuse if the site is another by now (0: do not care).
    virtual void apply_site(Site site, std::uint64_t expected_revision, Origin origin, std::function<void(SiteAnswer)> then) = 0;

    // --- axes ----------------------------------------------------------------------------------------------------------
    [[nodiscard]] virtual AxisPicture picture(AxisId axis) const = 0;
    /// Grows with every change of the picture.
    [[nodiscard]] virtual std::uint64_t picture_revision(AxisId axis) const = 0;
    /// One command, one result; the ticket is given by the gateway and told at once. Result::reason busy if too many wait.
    virtual Ticket submit(Command command, std::function<void(const Result&)> then) = 0;

    /// A streamed set-point, `at` included: the newest per axis counts, nothing is answered, and the axis' picture tells what came of it.
    virtual void set_point(SetPoint set_point) = 0;

    /// The last connection of a client has ended: what it commanded is treated as the axes' site entries say.
    virtual void client_lost(const AuthorityClient& /*who*/, LossCause /*cause*/) {}

    // --- parameters ----------------------------------------------------------------------------------------------------
    /// Last value that the drive said, asked for or not.
    [[nodiscard]] virtual LiveParameter live(AxisId axis, Point point) const = 0;
    /// Values written through the gateway and acknowledged, newest per parameter.
    [[nodiscard]] virtual std::vector<StoredParameter> stored(const std::string& axis) const = 0;
    [[nodiscard]] virtual std::vector<StoredParameter> history(const std::string& axis, const std::string& parameter, std::size_t limit) const = 0;

    // --- lines and drives ----------------------------------------------------------------------------------------------
    [[nodiscard]] virtual LineReport line_report(LineId line) const = 0;    ///< at most 200 ms old
    [[nodiscard]] virtual DriveStatus drive_status(DriveId drive) const = 0;
    struct Trace {
        std::vector<TraceEntry> entries;
        std::uint64_t missed = 0;      ///< asked for, but already overwritten
        std::uint64_t next = 0;        ///< `since` for the next call
    };
    /// Frames with sequence >= since, at most `limit`.
    [[nodiscard]] virtual Trace trace(LineId line, std::uint64_t since, std::size_t limit) const = 0;
    /// Looks for drives on a line; empty: it has begun, else why not.
    virtual void start_scan(LineId line, ScanWish wish, Origin origin, std::function<void(std::string)> then) = 0;
    virtual void cancel_scan(LineId line, std::function<void(ScanReport)> then) = 0;
    virtual void scan_report(LineId line, std::function<void(ScanReport)> then) = 0;
    /// The tester's hand of a twin; nothing if the drive is not simulated now.
    virtual void hand(DriveId drive, std::function<void(std::optional<std::vector<HandItem>>)> then) = 0;
    /// Sets several items, all or none; empty: good, else what is wrong.
    virtual void set_hand(DriveId drive, std::vector<std::pair<std::string, Value>> items, Origin origin, std::function<void(std::string)> then) = 0;

    // --- Modbus locks --------------------------------------------------------------------------------------------------
    struct ModbusConnection {
        std::string peer;
        std::uint64_t requests = 0, writes = 0, exceptions = 0;
        std::int64_t since_unix_ns = 0;
        std::vector<std::string> holds;  ///< axes
    };
    struct ModbusReport {
        std::string bind;
        std::vector<std::string> allow, functions;  ///< empty: all
        bool read_only = false;
        std::vector<ModbusConnection> connections;
    };
    /// Nothing: there is no Modbus door, or it is too busy to say.
    virtual void modbus_report(std::function<void(std::optional<ModbusReport>)> then) { then(std::nullopt); }
    /// Empty: done and stored; else why not, and whether it was the database that could not keep it.
    virtual void set_modbus_read_only(bool, Origin, std::function<void(std::string fault, bool not_stored)> then) { then("there is no Modbus door", false); }

    // --- events --------------------------------------------------------------------------------------------------------
    [[nodiscard]] virtual std::vector<Event> events(const EventQuery& query) const = 0;
    /// Calls `then` when events() tells of everything that has happened until now: what happened a moment ago may still be on its way to
    /// the disk. At once if the gateway is too busy to say.
    virtual void events_settled(std::function<void()> then) { then(); }
    virtual void listen(GatewayListener* listener) = 0;
    virtual void unlisten(GatewayListener* listener) = 0;
    /// Something that a door wants to be kept and streamed; id and time are filled in.
    virtual void note(Event event) = 0;

    // --- documents -----------------------------------------------------------------------------------------------------
    /// Small named texts of the doors' own: recipes, reports of their runs.
    struct Document {
        std::string name, text, who;
        std::int64_t at_unix_ns = 0;
    };
    /// In order of name.
    [[nodiscard]] virtual std::vector<Document> documents(const std::string& kind) const = 0;
    [[nodiscard]] virtual std::optional<Document> document(const std::string& kind, const std::string& name) const = 0;
    /// Answers when it is on disk; empty: good, else what is wrong.
    virtual void save_document(const std::string& kind, Document document, std::function<void(std::string)> then) = 0;
    virtual void delete_document(const std::string& kind, const std::string& name, std::function<void(std::string)> then) = 0;

    // --- what is kept --------------------------------------------------------------------------------------------------
    /// In order of n, without their values.
    [[nodiscard]] virtual std::vector<SnapshotInfo> snapshots(const std::string& axis) const = 0;
    [[nodiscard]] virtual std::optional<AxisSnapshot> snapshot(const std::string& axis, std::uint32_t n) const = 0;
    /// `then`: its number, or 0 and why it could not be stored.
    virtual void save_snapshot(AxisSnapshot snapshot, std::string axis, std::function<void(std::uint32_t n, std::string fault)> then) = 0;
    virtual void delete_snapshot(std::string axis, std::uint32_t n, std::function<void(std::string fault)> then) = 0;
    /// Newest first, without the documents, at most `limit`; with `before` those of smaller numbers.
    [[nodiscard]] virtual std::vector<SiteRevision> site_history(std::size_t limit, std::uint64_t before) const = 0;
    [[nodiscard]] virtual std::optional<SiteRevision> site_revision(std::uint64_t revision) const = 0;

    // --- staged changes of the site ------------------------------------------------------------------------------------
    [[nodiscard]] virtual const SiteStage& site_stage() const = 0;
    /// Each: empty, or why not. Origin tells who; an identity is the same from any port.
    virtual std::string stage_site(Site site, std::uint64_t base_revision, const Origin& origin) = 0;
    virtual std::string discard_stage() = 0;
    /// Puts the staged site in force. `confirm_within_s` 0: for good; else it is taken back by itself unless it is confirmed in that time.
    virtual void apply_stage(std::uint32_t confirm_within_s, Origin origin, std::function<void(SiteAnswer)> then) = 0;
    virtual void confirm_stage(Origin origin, std::function<void(std::string fault)> then) = 0;
    virtual void roll_back_stage(Origin origin, std::function<void(SiteAnswer)> then) = 0;

    // --- registers ---------------------------------------------------------------------------------------------------------
    /// What a client of a register door would read now; nothing: too much is asked at once.
    virtual void read_registers(std::uint8_t unit, registers::Table table, std::uint16_t address, std::uint16_t count,
                                std::function<void(std::optional<registers::RegisterRead>)> then) = 0;

    // --- the database as one file --------------------------------------------------------------------------------------
    /// A whole, checked copy of the database, or nothing and why.
    virtual void backup(std::function<void(std::optional<std::string> bytes, std::string fault)> then) = 0;
    /// Why a backup was not laid down; `text` empty: it was. Faults name no path.
    struct RestoreFault {
        std::string text;
        bool no_room = false;  ///< the backup may be good: this machine could not keep it
    };
    /// Checks a backup and lays it down to be taken at the next start.
    virtual void restore(std::string bytes, Origin origin, std::function<void(RestoreFault)> then) = 0;
    /// A backup that was laid down and waits for the next start.
    struct WaitingBackup {
        std::int64_t at_unix_ns = 0;
        std::string who;                  ///< empty: not known
        std::uint64_t bytes = 0;
        int version = 0;                  ///< of the database's structure; 0: not known
        std::uint64_t site_revision = 0;  ///< in force in it; 0: none, or not known
    };
    virtual void waiting_backup(std::function<void(std::optional<WaitingBackup>)> then) = 0;
    /// Takes it away again: empty, or why not; nothing waits: "none".
    virtual void cancel_restore(Origin origin, std::function<void(std::string fault)> then) = 0;
};

}  // namespace axisgate
