// The engine connects the doors with the adapters. Commands pass the guard and the profile and go to the adapter of their line; frames
// return as feedback, which updates the image. The engine has no clock, thread, socket, file or log: a line is an interface (`struct
// Line`), and everything else outside is EngineHost.
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

namespace axisgate::engine {
struct Axis;
}

namespace axisgate {

/// A parameter write that the drive has acknowledged, and that must be on the disk before the client gets its answer.
struct StoreOrder {
    Ticket ticket = no_ticket;  ///< a ticket of the engine, with which Engine::on_stored is called
    AxisId axis = no_axis;
    std::string axis_name, parameter, storage;
    Value value, previous;
    Origin origin;
};

/// The services that the engine needs from its environment. All calls come on the hot thread, from inside a call of the engine.
struct EngineHost {
    /// Makes a line for a URI other than `twin`. The line may become ready later; nullptr is not allowed.
    virtual std::unique_ptr<Line> make_line(const LineSpec& spec, const LineSetup& setup) = 0;
    /// Delivers the result of a command, with the ticket of the command.
    virtual void on_result(const Result& result) = 0;
    /// Delivers an event. Names are filled in, `id` and `at_unix_ns` are not; `at` is the instant.
    virtual void on_event(Event event, Instant at) = 0;
    virtual void on_sample(const Sample& sample) = 0;
    virtual void on_store(StoreOrder order) = 0;
    /// The time of the last message of a client that has commanded. Empty if it is not connected, or if its door does not monitor its
    /// clients.
    [[nodiscard]] virtual std::optional<Instant> last_received(const AuthorityClient&) const { return std::nullopt; }
    /// The non-volatile memory of a twin has changed.
    virtual void on_twin_memory(const std::string& drive, NonVolatile memory) = 0;
    virtual ~EngineHost() = default;
};

/// The data that apply_site needs in addition to the site: memories of twins by drive name, stored parameter values by axis name and id.
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

    /// Records all inputs and outputs of the engine from now on (flight_record.hpp); null ends this. The tap must outlive the engine.
    void set_tap(FlightTap* tap) noexcept;
    /// Puts a checked site in force at once. Lines, drives and axes that do not change continue undisturbed.
    std::shared_ptr<const SiteState> apply_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now);
    using Applied = std::function<void(std::shared_ptr<const SiteState>)>;
    /// Puts a site in force after the moving axes that it removes or replaces were stopped by their drives. `then` is called when all of
    /// them stand, 5 s later at the latest, or from inside this call if nothing moves.
    void change_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now, Applied then);
    [[nodiscard]] const std::shared_ptr<const SiteState>& site() const noexcept;

    void on_command(Command command, Instant now);
    /// Empty if the set-point was passed on, otherwise the refusal. The picture of the axis shows both as well (streaming, set_points,
    /// set_point_refusal).
    std::optional<Refusal> on_set_point(const SetPoint& set_point, Instant now);
    /// Duration of the lease that a command takes on an axis of mode "lease".
    void set_lease(Duration lease) noexcept;
    /// How long a Modbus client that commands an axis may be silent if the axis' site entry does not say it; 0: for ever.
    void set_watchdog(Duration limit) noexcept;
    /// A client is gone, and the `fail_safe` entries of the axes that it commanded last are applied. With set_points_silent only the
    /// connection that carried its set-points is gone: only the streams end, and the set-points of a DDS client have then missed their
    /// deadline (dds_deadline).
    void on_client_lost(const AuthorityClient& who, LossCause cause, Instant now);
    /// The time from the acceptance of a command to the transmission of its first frame on a real line; any thread. One command per line at
    /// a time is measured.
    [[nodiscard]] const Histogram& write_to_frame() const noexcept;
    /// How often axes were stopped since the start because of this cause.
    [[nodiscard]] std::uint64_t losses(LossCause cause) const noexcept;
    /// The store has recorded an order, or has failed to (`fault` is not empty).
    void on_stored(Ticket order, const std::string& fault, Instant now);

    [[nodiscard]] Instant deadline() const;
    void on_deadline(Instant now);
    /// Waking up costs more than the work that it is for.
    static constexpr Duration twins_wait = std::chrono::microseconds(250);
    /// The deadline for hosts to which each call costs a wake-up. On a line with no outstanding order, the frames of simulated drives and
    /// their consequences are handled later by this amount, all together. Each of them keeps its own instant.
    [[nodiscard]] Instant wake_at() const;
    /// True if nothing moves, no client waits for an answer, and nothing was commanded, found or lost for a second. Work that is due may
    /// then be done together with work that is due a little later.
    [[nodiscard]] bool at_rest(Instant now) const noexcept;

    [[nodiscard]] const Catalogue* catalogue(AxisId axis) const;
    /// Starts a search for drives on a line. Empty if it has begun, otherwise the reason why not.
    [[nodiscard]] std::string start_scan(LineId line, ScanWish wish, Instant now);
    void cancel_scan(LineId line, Instant now);
    [[nodiscard]] ScanReport scan_report(LineId line) const;
    /// Polls axes of one line every `period` for a while, as far as the line has capacity beside the polls of its other drives; zero ends
    /// this. It ends automatically at `until`, `longest_look` from now at most. Empty if it was accepted, otherwise the reason why not.
    static constexpr Duration longest_look = std::chrono::minutes(10), shortest_look_period = std::chrono::milliseconds(1);
    [[nodiscard]] std::string look_closely(const std::vector<AxisId>& axes, Duration period, Instant until, Instant now);
    [[nodiscard]] LineReport line_report(LineId line, Instant now) const;
    [[nodiscard]] DriveStatus drive_status(DriveId drive) const;
    /// The log outlives the line for its remaining readers.
    [[nodiscard]] std::shared_ptr<const FrameLog> frame_log(LineId line) const;
    /// The conditions of a simulated drive; only for drives that are simulated now.
    [[nodiscard]] Twin* twin(DriveId drive);
    [[nodiscard]] std::string set_hand(DriveId drive, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin,
                                       Instant now);
    /// The twin of this drive starts with this memory when it serves the axes next, and the memory is stored. Empty, or the reason why not:
    /// a twin that serves now keeps its own.
    [[nodiscard]] std::string adopt(DriveId drive, NonVolatile memory, const Origin& origin, Instant now);
    /// True when every line is up, or its drives are served by twins, or its first attempts have failed for a known reason.
    [[nodiscard]] bool settled() const;
    /// The reasons why the gateway is not ready, one sentence each: lines that are down, drives that are offline.
    [[nodiscard]] std::vector<std::string> complaints() const;
    /// Stops every axis that is not at rest and closes all lines. The end of the gateway counts as a loss of command.
    void shut_down(Instant now);

    struct Parts;  // defined in engine_parts.hpp
    /// The parts, for benchmarks and tests of one of them. Only on the hot thread.
    [[nodiscard]] Parts& parts() noexcept { return *parts_; }

private:
    void housekeeping(Instant now);
    void end_lapsed_lease(AxisId axis, const Origin& origin, Instant now);
    void end_lapsed_lease(engine::Axis& axis, Instant now);

    std::unique_ptr<Parts> parts_;
    Instant next_housekeeping_{};
};

}  // namespace axisgate
