// Engine: the round. Commands go down through guard and profile to the adapter of their line; frames come up as feedback into the image.
// In: the wanted site, commands, what lines report, the passing of time. Out: one result per ticket, the image, events, store orders.
// Never touches a clock, thread, socket, file or log: lines are behind `struct Line`, everything else behind EngineHost.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "gateway/axis/authority.hpp"
#include "gateway/axis/cia402.hpp"
#include "gateway/axis/guard.hpp"
#include "gateway/core/event.hpp"
#include "gateway/core/histogram.hpp"
#include "gateway/core/line.hpp"
#include "gateway/core/scan.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/engine/door.hpp"
#include "gateway/engine/report.hpp"
#include "gateway/site/fail_safe.hpp"
#include "gateway/site/site.hpp"
#include "gateway/site/site_state.hpp"
#include "gateway/wire/frame_log.hpp"
#include "gateway/wire/twin_bus.hpp"

namespace axisgate {

/// A parameter write that the drive has acknowledged and that must be on disk before the client hears of it.
struct StoreOrder {
    Ticket ticket = no_ticket;  ///< of the engine; comes back through Engine::on_stored
    AxisId axis = no_axis;
    std::string axis_name, parameter, storage;
    Value value, previous;
    Origin origin;
};

/// What the engine needs from the world around it. All calls come on the hot thread, from inside an engine call.
struct EngineHost {
    /// A line for a URI other than `twin`. It may come up later; nullptr is not allowed.
    virtual std::unique_ptr<Line> make_line(const LineSpec& spec, const LineSetup& setup) = 0;
    /// Results of commands, with the ticket that came with them.
    virtual void on_result(const Result& result) = 0;
    /// Names are filled in, `id` and `at_unix_ns` are not; `at` is the instant.
    virtual void on_event(Event event, Instant at) = 0;
    virtual void on_sample(const Sample& sample) = 0;
    virtual void on_store(StoreOrder order) = 0;
    /// When a client that has commanded was last heard on its door; nothing: it is not connected, or its door does not watch.
    [[nodiscard]] virtual std::optional<Instant> last_received(const AuthorityClient&) const { return std::nullopt; }
    /// A twin's non-volatile memory has changed.
    virtual void on_twin_memory(const std::string& drive, NonVolatile memory) = 0;
    virtual ~EngineHost() = default;
};

/// What apply_site needs to know besides the site: memories of twins by drive name, stored parameter values by axis name and id.
struct SiteMemory {
    std::map<std::string, NonVolatile> twins;
    std::map<std::string, std::map<std::string, Value>> stored;
};

class FlightTap;

class Engine {
public:
    Engine(Families families, EngineHost& host, Image& image, std::size_t trace_frames = 4096);
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    /// Is told from now on what the engine is given and what it tells (flight_record.hpp); null: nobody is. It outlives the engine.
    void set_tap(FlightTap* tap) noexcept;
    /// Puts a checked site in force, at once. Lines, drives and axes that are the same go on undisturbed.
    std::shared_ptr<const SiteState> apply_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now);
    using Applied = std::function<void(std::shared_ptr<const SiteState>)>;
    /// apply_site, after what the site takes away or makes anew while it moves has been stopped by its drive's own means. `then` is told as
    /// soon as all of it stands, 5 s later at the latest, or from inside this call where nothing moves.
    void change_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now, Applied then);
    [[nodiscard]] const std::shared_ptr<const SiteState>& site() const noexcept;

    void on_command(Command command, Instant now);
    /// Nothing: it was handed on; else why not. The axis' picture tells both as well (streaming, set_points, set_point_refusal).
    std::optional<Refusal> on_set_point(const SetPoint& set_point, Instant now);
    /// How long a command holds an axis of mode "lease".
    void set_lease(Duration lease) noexcept;
    /// How long a Modbus client that commands an axis may be silent, where the axis' site entry does not say it; 0: for ever.
    void set_watchdog(Duration limit) noexcept;
    /// A client is gone: what it commanded last is treated as the axes' site entries say. With set_points_silent, the connection by which
    /// it streamed: only what it streams is, and a DDS client's set-points have then missed their deadline (dds_deadline).
    void on_client_lost(const AuthorityClient& who, LossCause cause, Instant now);
    /// From a command's being taken to its first frame having left on a real line; any thread. One command per line at a time is measured.
    [[nodiscard]] const Histogram& write_to_frame() const noexcept;
    /// How often axes were stopped since the start because of this cause.
    [[nodiscard]] std::uint64_t losses(LossCause cause) const noexcept;
    /// The store has (`fault` empty) or has not recorded an order.
    void on_stored(Ticket order, const std::string& fault, Instant now);

    [[nodiscard]] Instant deadline() const;
    void on_deadline(Instant now);
    /// A wake-up costs more than what it finds.
    static constexpr Duration twins_wait = std::chrono::microseconds(250);
    /// When to call on_deadline where each call costs a wake-up: what simulated drives say on a line to which no order is on its way is
    /// seen to so much later, together with what follows. Each of it keeps its own instant.
    [[nodiscard]] Instant wake_at() const;
    /// Nothing moves, nobody waits for an answer, and for a second nothing was commanded, found or lost: what is due may be met together
    /// with what is due a little later.
    [[nodiscard]] bool at_rest(Instant now) const noexcept;

    [[nodiscard]] const Catalogue* catalogue(AxisId axis) const;
    /// Looks for drives on a line. Empty: it has begun; else why not.
    [[nodiscard]] std::string start_scan(LineId line, ScanWish wish, Instant now);
    void cancel_scan(LineId line, Instant now);
    [[nodiscard]] ScanReport scan_report(LineId line) const;
    /// Axes of one line are asked every `period` for a while, as far as the line has room besides what its other drives are owed; zero: no
    /// more. It ends by itself at `until`, `longest_look` from now at most. Empty: so it is; else why not.
    static constexpr Duration longest_look = std::chrono::minutes(10), shortest_look_period = std::chrono::milliseconds(1);
    [[nodiscard]] std::string look_closely(const std::vector<AxisId>& axes, Duration period, Instant until, Instant now);
    [[nodiscard]] LineReport line_report(LineId line, Instant now) const;
    [[nodiscard]] DriveStatus drive_status(DriveId drive) const;
    /// Outlives the line for those who still read it.
    [[nodiscard]] std::shared_ptr<const FrameLog> frame_log(LineId line) const;
    /// The tester's hand; nullptr-free only for drives that are simulated now.
    [[nodiscard]] Twin* twin(DriveId drive);
    [[nodiscard]] std::string set_hand(DriveId drive, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin,
                                       Instant now);
    /// True as soon as every line is up, or its drives are served by twins, or its first attempts have failed for good reason.
    [[nodiscard]] bool settled() const;
    /// What is not as it should be, a sentence each: lines down, drives offline.
    [[nodiscard]] std::vector<std::string> complaints() const;
    /// Stops every axis that is not at rest and closes all lines: the gateway's own end is a loss of command.
    void shut_down(Instant now);

    struct Parts;  // engine_parts.hpp
    /// Its parts, for benchmarks and tests that look at one of them alone. Only on the hot thread.
    [[nodiscard]] Parts& parts() noexcept { return *parts_; }

private:
    void housekeeping(Instant now);

    std::unique_ptr<Parts> parts_;
    Instant next_housekeeping_{};
};

}  // namespace axisgate
