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
    [[nodiscard]] virtual std::optional<Instant> heard(const AuthorityClient&) const { return std::nullopt; }
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
    void set_tap(FlightTap* tap) noexcept { tap_ = tap; }
    /// Puts a checked site in force, at once. Lines, drives and axes that are the same go on undisturbed.
    std::shared_ptr<const SiteState> apply_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now);
    using Applied = std::function<void(std::shared_ptr<const SiteState>)>;
    /// apply_site, after what the site takes away or makes anew while it moves has been stopped by its drive's own means. `then` is told as
    /// soon as all of it stands, 5 s later at the latest, or from inside this call where nothing moves.
    void change_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now, Applied then);
    [[nodiscard]] const std::shared_ptr<const SiteState>& site() const noexcept { return site_; }

    void on_command(Command command, Instant now);
    /// Nothing: it was handed on; else why not. The axis' picture tells both as well (streaming, set_points, set_point_refusal).
    std::optional<Refusal> on_set_point(const SetPoint& set_point, Instant now);
    /// How long a command holds an axis of mode "lease".
    void set_lease(Duration lease) noexcept { lease_ = lease; }
    /// How long a Modbus client that commands an axis may be silent, where the axis' site entry does not say it; 0: for ever.
    void set_watchdog(Duration limit) noexcept { watchdog_ = limit; }
    /// A client is gone: what it commanded last is treated as the axes' site entries say. With set_points_silent, the connection by which
    /// it streamed: only what it streams is, and a DDS client's set-points have then missed their deadline (dds_deadline).
    void on_client_lost(const AuthorityClient& who, LossCause cause, Instant now);
    /// How often axes were stopped since the start because of this cause.
    /// From a command's being taken to its first frame having left on a real line; any thread. One command per line at a time is measured.
    [[nodiscard]] const Histogram& write_to_frame() const noexcept { return write_to_frame_; }
    [[nodiscard]] std::uint64_t losses(LossCause cause) const noexcept { return losses_[static_cast<std::size_t>(cause)]; }
    /// The store has (`fault` empty) or has not recorded an order.
    void on_stored(Ticket order, const std::string& fault, Instant now);

    [[nodiscard]] Instant deadline() const;
    void on_deadline(Instant now);
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

private:
    struct Axis;
    struct Drive;
    struct LineUnit;
    struct Side;
    struct Speaker;
    struct Client;
    struct OrderRecord;
    struct Scan;
    struct Change;

    // routing (engine.cpp)
    void drain(Speaker& by, Out& out, Instant now);
    /// One call of an adapter, and what it gave back handed on.
    template <class F>
    void ask(Speaker& by, Instant now, F&& call);
    // from a command to its orders (engine_command.cpp)
    struct Plan;
    [[nodiscard]] std::optional<Refusal> turned_away(const Axis& axis, const Command& command, Instant now) const;
    [[nodiscard]] std::string use_hand(DriveId drive, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin,
                                       Instant now);
    void answer_hand(const Axis& axis, const Command& command, const Hand& hand, Instant now);
    [[nodiscard]] std::optional<Refusal> plan_for(Axis& axis, Command& command, Plan& plan, Instant now);
    [[nodiscard]] std::optional<Refusal> plan_parameter(const Axis& axis, CommandBody& body, Plan& plan) const;
    [[nodiscard]] std::optional<Refusal> plan_motion(Axis& axis, Command& command, Plan& plan, Instant now);
    [[nodiscard]] static ProcessData stop_alone(const ProcessData& data);
    void give_the_stop_alone(const Command& command, Instant now);
    [[nodiscard]] static bool needs_authority(const Command& command, const Plan& plan);
    void note_command(const Axis& axis, const Command& command, const Plan& plan, Instant now);
    void carry_out(Axis& axis, Command&& command, Plan&& plan, Instant now);
    void give_order(Axis& axis, Client* client, CommandBody body, Origin origin, Instant now);
    [[nodiscard]] std::optional<Refusal> beyond_limits(const Axis& axis, const CommandBody& body) const;
    void remember_ramp(Axis& axis, const CommandBody& body);
    void remember_prepared(Axis& axis, const CommandBody& body);
    void order_result(const Result& result, Instant now);
    void finish(std::uint64_t client, Result result, Instant now);
    void refuse(const Command& command, Reason reason, std::string text);
    void feedback(Side& side, AxisId axis, const AxisFeedback& value, Instant now);
    void track(Axis& axis, Instant now);
    void publish(Axis& axis, Instant now);
    void event(Event e, Instant now);
    void answer(const Result& result);
    void tell_sample(const Sample& sample, Instant now);
    void tap_site(const Site& site, const SiteMemory& memory, std::uint64_t revision, bool at_once, Instant now);
    std::shared_ptr<const SiteState> put_in_force(Site site, SiteMemory memory, std::uint64_t revision, Instant now);
    [[nodiscard]] Side* side_of(const Drive& drive) const;
    [[nodiscard]] static Speaker& speaker_of(const Side& side, const Drive& drive);
    // authority (engine_authority.cpp)
    [[nodiscard]] AxisAuthority::Verdict may_command(const Axis& axis, const Command& command, Instant now) const;
    /// Ends motion and nothing else: not asked for a lease.
    [[nodiscard]] static bool only_stops(const Axis& axis, const CommandBody& body);
    /// Nothing: the client is noted as the one who commands; else another client holds the axis, by its name.
    [[nodiscard]] std::optional<Refusal> ask_authority(Axis& axis, const Command& command, Instant now);
    void note_commander(Axis& axis, const Origin& origin, Instant now);
    void hold(Axis& axis, const Command& command, const HoldAxis& wish, Instant now);
    void authority_changed(Axis& axis, const AxisAuthority::Verdict& verdict, const Origin* by, Instant now);
    void supersede(Axis& axis, std::uint64_t by, std::string_view what, Instant now);
    [[nodiscard]] bool hold_on(Axis& axis, const Command& command, Instant now);
    void begin_hold(Axis& axis, const Move& move, const Origin& origin);
    void check_hold(Axis& axis, Instant now);
    void check_run(Axis& axis, Instant now);

    // streamed set-points (engine_stream.cpp)
    [[nodiscard]] std::optional<Refusal> against(const Axis& axis, const SetPoint& set_point, const AuthorityClient& who,
                                                 Instant now) const;
    [[nodiscard]] std::optional<Refusal> too_far(const Axis& axis, const SetPoint& set_point) const;
    void begin_stream(Axis& axis, const SetPoint& set_point, const AuthorityClient& who, Instant now);
    void end_stream(Axis& axis, Reason reason, const std::string& why, Instant now);
    void tell_stream(const Axis& axis, const Origin& by, Severity severity, std::string text, Instant now);
    void stream_refused(const Side& side, const Out::StreamEnd& end, Instant now);
    void check_stream(Axis& axis, Instant now);

    // loss of command (engine_fail_safe.cpp)
    void fail_safe(Axis& axis, LossCause cause, Instant now);
    [[nodiscard]] static AtLoss at_loss(const Axis& axis);
    /// What the silence of a client that streams set-points is called.
    [[nodiscard]] static LossCause silence_of(const AuthorityClient& who) noexcept {
        return who.door == Door::dds ? LossCause::dds_deadline : LossCause::set_points_silent;
    }
    void check_watchdog(Axis& axis, Instant now);

    // the site (engine_site.cpp), presence (engine_presence.cpp), time (engine_turn.cpp), questions (engine_ask.cpp)
    void build_line(LineUnit& unit, Instant now);
    void tell_options(std::span<LineUnit* const> lines, std::span<Drive* const> drives, Instant now);
    void configure_side(Side& side, Instant now);
    void configure(Speaker& speaker, Instant now);
    Speaker& bring_in(Side& side, const FamilyEntry& family, Instant now);
    void fit_speakers(Side& side, Instant now);
    [[nodiscard]] LineSetup setup_for(const LineUnit& unit) const;
    [[nodiscard]] LineSetup setup_for(const Speaker& speaker) const;
    void line_state(Side& side, bool up, const std::string& why, Instant now);
    void link(Side& side, const DriveLink& link, Instant now);
    void decide_presence(Drive& drive, Instant now);
    void serve(Drive& drive, Presence by, std::string why, Instant now);
    void plug_in_twin(Drive& drive, Instant now);
    void refit_twin(Drive& drive, Instant now);
    void begin_handback(Drive& drive, Instant now);
    bool handback_result(const Result& result, Instant now);
    void housekeeping(Instant now);
    void end_looks(Instant now);
    void save_twin_memory(Drive& drive);
    void drop_axis(Axis& axis, std::string_view why, Instant now);
    void new_source(Axis& axis);

    // the site changes in motion (engine_leave.cpp)
    [[nodiscard]] bool online(const Axis& axis) const;
    [[nodiscard]] bool awaits_answer(const Axis& axis) const;
    [[nodiscard]] bool under_way(const Axis& axis) const;
    void check_change(Instant now);
    void put_change_in_force(Instant now);

    // scans (engine_scan.cpp)
    [[nodiscard]] static bool is_probe(DriveId id) noexcept;
    [[nodiscard]] std::string not_to_be_searched(const LineUnit& unit, const FamilyEntry& wanted, std::string_view name) const;
    void scan_turn(LineUnit& unit, Instant now);
    void scan_link(Side& side, const DriveLink& link);
    void end_scan(LineUnit& unit, ScanReport::State state, std::string why, Instant now);

    Axis* axis(AxisId id) const;
    Drive* drive(DriveId id) const;

    Out take_out();
    void give_back(Out&& out);

    Families families_;
    EngineHost& host_;
    FlightTap* tap_ = nullptr;
    Image& image_;
    std::shared_ptr<const SiteState> site_;
    std::vector<std::unique_ptr<LineUnit>> lines_;                        // by LineId; null: removed
    std::vector<std::unique_ptr<Drive>> drives_;                          // by DriveId
    std::vector<std::unique_ptr<Axis>> axes_;                             // by AxisId
    std::vector<Side*> sides_;                                            // all that exist, for the deadline scan
    std::unordered_map<std::uint64_t, std::unique_ptr<Client>> clients_;  // by own number
    Histogram write_to_frame_;
    std::unordered_map<Ticket, OrderRecord> orders_;  // by the ticket that the adapter or the store has
    std::vector<Out> spare_;
    std::unique_ptr<Change> change_;
    std::uint64_t next_ = 1;
    Instant now_{};
    Instant next_housekeeping_{};
    Instant last_stir_{};  ///< when something moved, was commanded, found or lost
    std::size_t trace_frames_;
    std::uint32_t sources_ = 0;
    Duration lease_ = std::chrono::seconds(30);
    Duration watchdog_ = std::chrono::seconds(5);
    std::array<std::uint64_t, loss_causes.size() + 1> losses_{};
    bool closing_ = false;
};

}  // namespace axisgate
