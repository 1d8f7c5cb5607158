// The engine's records of lines, drives, axes and waiting clients. They are plain data, except for the event handler of a line; each part
// of the engine is given the records that it works on.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "gateway/axis/authority.hpp"
#include "gateway/axis/cia402.hpp"
#include "gateway/axis/guard.hpp"
#include "gateway/core/histogram.hpp"
#include "gateway/engine/engine.hpp"
#include "gateway/engine/motion.hpp"
#include "gateway/site/fail_safe.hpp"
#include "gateway/wire/twin_bus.hpp"

namespace axisgate::engine {

class Clients;
class CommandAuthority;
class Commands;
class LossOfCommand;
class Motions;
class Orders;
class Presences;
class Publisher;
class Routing;
class Scans;
class SiteInForce;
class Speakers;
class Streams;
class Supervisor;
class Twins;

struct LineUnit;
struct Side;

/// The adapter of one family on a side. It serves the drives of its family and of families that share its adapter. Several of them may
/// share a CAN line; each receives the frames with its own identifiers.
struct Speaker {
    Speaker(Side& s, FamilyEntry f, std::uint8_t n) : side(s), family(f), number(n) {}
    Side& side;
    FamilyEntry family;
    std::uint8_t number;  ///< Frame::sender of the frames that it sends
    std::unique_ptr<Adapter> adapter;
    std::vector<CanIdentifiers> identifiers;
    bool receives_all = true;
    std::vector<DriveSetup> probes;              ///< addresses that a scan is asking now
    std::optional<AdapterCounters> before_scan;  ///< its counters when the running scan began to use it
    AdapterCounters scanned;                     ///< counted during earlier scans

    /// The counters during scans, including the running one.
    [[nodiscard]] AdapterCounters scanned_now(const AdapterCounters& counted) const noexcept {
        AdapterCounters all = scanned;
        if (before_scan) all += difference(counted, *before_scan);
        return all;
    }
    static AdapterCounters difference(const AdapterCounters& now, const AdapterCounters& before) noexcept {
        return {now.exchanges - before.exchanges, now.timeouts - before.timeouts, now.retries - before.retries,
                now.refused - before.refused,     now.garbled - before.garbled,   now.unexpected - before.unexpected};
    }

    [[nodiscard]] bool receives(const Frame& f) const noexcept {
        return receives_all || f.kind != Frame::Kind::can || any_holds(identifiers, f);
    }
};

/// True if this adapter serves drives of one of these families.
[[nodiscard]] inline bool serves_any(const Speaker& s, std::span<const FamilyEntry> families) {
    return std::ranges::any_of(families, [&](const FamilyEntry& f) { return &serving_family(*f.family) == s.family.family; });
}

/// The adapters of one line and the medium that they use: the real line, or the twin bus beside it.
struct Side final : LineEvents {
    Side(Routing& r, LineUnit& u, bool is_twin) : routing(r), unit(u), twin(is_twin) {}
    Routing& routing;
    LineUnit& unit;
    bool twin;
    bool up = false;
    bool tried = false;  ///< the line has reported its state at least once
    std::string why = "not opened yet";
    std::vector<std::unique_ptr<Speaker>> speakers;  ///< by family; most_families_on_a_line at most, and those of a scan
    std::unique_ptr<Line> line;
    std::uint64_t unclaimed = 0;  ///< CAN frames that belong to none of them
    TwinBus* bus = nullptr;       ///< on the twins' side, the same object as `line`
    /// Must be called after calls of the side's line or adapters, so that its deadline is read again. drain() does this for most of them.
    void touched() noexcept;
    [[nodiscard]] Instant deadline() const { return std::min(line->deadline(), adapters_deadline()); }
    [[nodiscard]] Instant adapters_deadline() const {
        Instant due = never;
        for (const auto& s : speakers)
            due = std::min(due, s->adapter->deadline());
        return due;
    }
    class Sides* among = nullptr;  ///< the list that keeps its deadline, and the index there
    std::size_t place = 0;
    [[nodiscard]] Speaker* speaker_of(const FamilyEntry& family) const noexcept {
        const Family& serves = serving_family(*family.family);
        const auto it = std::ranges::find_if(speakers, [&](const auto& s) { return s->family.family == &serves; });
        return it == speakers.end() ? nullptr : it->get();
    }

    void on_frame(const Frame& frame) override;
    void on_line_state(bool now_up, const std::string& text) override;
    void on_sent(const Frame& frame) override;

    /// One command at a time is followed until its frame was sent, for the histogram; commands that arrive meanwhile are not. Real lines
    /// only.
    struct Followed {
        Ticket ticket = no_ticket;  ///< none: the next command will be followed
        Instant since{};
        bool handed_on = false;  ///< `frame` is in the line's queue
        Frame frame;
    } followed;
};

/// All sides in the order of their creation, with a heap of their deadlines. A turn of the engine visits only the sides that are due, and
/// reads only the deadlines of sides that were touched.
class Sides {
public:
    void add(Side& side) {
        side.among = this;
        all_.push_back(&side);
        begin_anew();
    }
    void remove(Side& side) {
        side.among = nullptr;
        std::erase(all_, &side);
        begin_anew();
    }
    [[nodiscard]] auto begin() const noexcept { return all_.begin(); }
    [[nodiscard]] auto end() const noexcept { return all_.end(); }

    void touched(std::size_t place) noexcept {
        if (std::exchange(to_ask_[place], char{1}) != 0) return;
        asked_for_.push_back(place);  // add() has reserved the capacity
    }
    [[nodiscard]] Instant earliest() {
        ask();
        return heap_.empty() ? never : heap_.front().at;
    }
    /// The same, where frames of simulated drives on waiting sides may be handled later by this amount; adapters are always handled in
    /// time.
    [[nodiscard]] Instant earliest(Duration twins_wait, auto&& waits) {
        ask();
        Instant t = never;
        for (const auto [at, place] : heap_)
            t = std::min(t, all_[place]->twin && at < t && waits(*all_[place]) ? std::min(at + twins_wait, adapters_due_[place]) : at);
        return t;
    }
    /// The first side at this index or behind it that is due; nullptr if there is none.
    [[nodiscard]] Side* due(std::size_t from, Instant now) {
        ask();
        if (!is_due(0, now)) return nullptr;
        std::size_t first = all_.size();
        look(0, from, now, first);
        return first < all_.size() ? all_[first] : nullptr;
    }

private:
    struct Due {
        Instant at = never;
        std::size_t place = 0;
    };

    void begin_anew() {
        const std::size_t n = all_.size();
        adapters_due_.assign(n, never);
        heap_.resize(n);
        in_heap_.resize(n);
        to_ask_.assign(n, 0);
        asked_for_.clear();
        asked_for_.reserve(n);
        for (std::size_t i = 0; i < n; ++i) {
            all_[i]->place = in_heap_[i] = i;
            heap_[i] = {never, i};
            touched(i);
        }
    }
    void ask() {
        for (const std::size_t place : asked_for_) {
            to_ask_[place] = 0;
            adapters_due_[place] = all_[place]->adapters_deadline();
            const Due due{std::min(all_[place]->line->deadline(), adapters_due_[place]), place};
            const std::size_t at = in_heap_[place];
            due.at < heap_[at].at ? up(at, due) : down(at, due);
        }
        asked_for_.clear();
    }
    [[nodiscard]] bool is_due(std::size_t at, Instant now) const { return at < heap_.size() && heap_[at].at <= now; }
    void look(std::size_t at, std::size_t from, Instant now, std::size_t& first) const {  // called at a heap entry that is due
        if (heap_[at].place >= from) first = std::min(first, heap_[at].place);
        if (is_due(2 * at + 1, now)) look(2 * at + 1, from, now, first);
        if (is_due(2 * at + 2, now)) look(2 * at + 2, from, now, first);
    }
    void put(std::size_t at, const Due& due) noexcept {
        heap_[at] = due;
        in_heap_[due.place] = at;
    }
    void up(std::size_t at, const Due& due) noexcept {
        for (; at > 0 && due.at < heap_[(at - 1) / 2].at; at = (at - 1) / 2)
            put(at, heap_[(at - 1) / 2]);
        put(at, due);
    }
    void down(std::size_t at, const Due& due) noexcept {
        for (std::size_t child; (child = 2 * at + 1) < heap_.size(); at = child) {
            if (child + 1 < heap_.size() && heap_[child + 1].at < heap_[child].at) ++child;
            if (due.at <= heap_[child].at) break;
            put(at, heap_[child]);
        }
        put(at, due);
    }

    std::vector<Side*> all_;
    std::vector<Due> heap_;              ///< earliest first
    std::vector<std::size_t> in_heap_;   ///< by place
    std::vector<Instant> adapters_due_;  ///< by place
    std::vector<char> to_ask_;
    std::vector<std::size_t> asked_for_;
};
inline void Side::touched() noexcept {
    if (among) among->touched(place);
}

/// One search for drives on a line, kept for its report until the next one. Its families are searched for at the same time.
struct Scan {
    struct Asking {
        DriveId id = no_drive;
        std::string address;
        Instant since{};
        bool over = false, online = false;
        std::string text;
    };
    struct Part {
        FamilyEntry family;
        std::size_t report = 0;            ///< its index in ScanReport::parts
        std::vector<std::string> waiting;  ///< the next address is at the back
        std::vector<Asking> asking;
        std::size_t at_once = 1;
        [[nodiscard]] bool over() const noexcept { return waiting.empty() && asking.empty(); }
    };
    std::vector<Part> parts;
    [[nodiscard]] bool over() const noexcept { return std::ranges::all_of(parts, &Part::over); }
    std::uint32_t next_id = 0;
    Instant ends_at{};
    ScanReport report;
};

struct LineUnit {
    LineSpec spec;
    LineId id = no_line;
    FamilyEntry family;                 ///< of those of its drives that name no family; nullptrs if all of them name one
    std::vector<FamilyEntry> families;  ///< all families that the site has on it
    LineKind kind = LineKind::bytes;
    std::unique_ptr<Side> real;   ///< null on a line with the URI "twin"
    std::unique_ptr<Side> twins;  ///< null while no drive is simulated
    std::shared_ptr<FrameLog> log;
    std::vector<DriveId> drives;
    std::unique_ptr<Scan> scan;    ///< null: never scanned
    AdapterCounters scanned_gone;  ///< counters of adapters that existed only for a scan
    Duration stale_after{};
};

struct Drive {
    DriveSpec spec;
    DriveId id = no_drive;
    LineUnit* line = nullptr;
    FamilyEntry family;
    std::shared_ptr<const Catalogue> catalogue;  ///< the drive's own, or that of its family's page
    std::vector<AxisId> axes;
    Presence serving = Presence::offline;  ///< the side whose feedback is accepted: the device, the twin, or none
    /// True if the side that serves it answers.
    [[nodiscard]] bool answers() const noexcept {
        return serving == Presence::twin ? twin_online : serving == Presence::device && device_online;
    }
    bool device_online = false, twin_online = false;
    bool device_lost_while_commanded = false;
    Instant waiting_since{};  ///< when the adapter began to wait for the device
    DriveLink device_link, twin_link;
    std::string why = "not seen yet";
    int twin_axes = 1;  ///< number of axes of the running twin
    std::uint64_t memory_revision = 0;
    NonVolatile memory;  ///< the twin starts with this memory
    /// The device has returned: its parameters are read and compared before it serves its axes again.
    struct Handback {
        std::size_t waiting = 0;
        std::size_t compared = 0;
        std::size_t unread = 0;
        std::vector<std::string> differences;
    };
    std::unique_ptr<Handback> handback;
};

struct Axis {
    AxisSpec spec;
    AxisId id = no_axis;
    Drive* drive = nullptr;
    AxisLimits limits;
    Cia402Axis profile;
    Motion motion;                    ///< the motion that moves it
    std::size_t motions_asked = 0;    ///< orders on their way that will replace the record if the drive accepts them
    Motion asked;                     ///< the newest of these; the drive may carry it out before its answer arrives
    std::optional<Motion> suspected;  ///< an order that was sent and then failed, or that a stop followed: it may begin all the same
    std::optional<Motion> statement;  ///< the motion to assume if the axis moves without an order, because a statement was sent that could
                                      ///< not be read
    Origin waiting;                   ///< the client whose set-point waits behind the running motion, or waited last
    Stops stops;
    StopLatch latch;
    Watch watch;
    std::optional<Instant> rests_from;   ///< since when its feedback shows rest
    Instant moves_since{};               ///< since when it moves without a record, or against its state; the beginning of time: it does not
    std::int64_t speed_then = 0;         ///< speed at that instant, increments/s
    bool contradicts = false;            ///< it moves against its state, and an alarm has reported it
    std::optional<Move> prepared;        ///< accepted by the drive, starts with StartTogether
    std::int64_t last_deceleration = 0;  ///< of the last accepted move that named one, because a drive keeps it; 0: unknown
    /// The set-points that one client renews. The motion that they cause is `motion`.
    struct Stream {
        bool on = false;
        SetPoint::Mode mode = SetPoint::Mode::position;
        AuthorityClient who;
        Origin origin;
        std::int64_t value = 0;  ///< of the newest set-point that was passed to the drive
        Instant renewed{};       ///< by a set-point that was passed to the drive; a refused one does not renew the stream
        Duration good_for{};
        std::uint32_t taken = 0, refused = 0;
        Reason refusal = Reason::none;  ///< of the newest set-point, or of the stream
        Instant tell_again_at{};
        bool unpublished = false;  ///< the present refusal has not been reported as an event
        AuthorityClient ended_by;  ///< the client of the last stream, which must pause before its next one
        Instant ended_received{};  ///< time of its last set-point since then
        Reason ended_for = Reason::none;
        std::string ended_why;
    } stream;
    Ticket setpoint_ticket = no_ticket;  ///< the last set-point by a control word; it may wait and begin later, without its client
    Instant leaving_until{};             ///< a site change removes the axis, and nothing may begin here until then
    bool at_limit = false;               ///< a motion was ended at a limit, and none has begun since
    AxisAuthority authority;
    std::optional<AtLoss> lost_line;  ///< its drive fell silent while this axis was commanded, and has not reported since
    Duration look_period{};           ///< zero: polled at the line's period
    Instant look_until{};
    bool stale = true;
    bool was_fault = false;
    bool was_safe_stop = false;
    std::string homing_why;  ///< the adapter's notice about the reason why the last homing failed
    std::uint16_t last_error = 0;
    std::vector<std::uint64_t> clients;  ///< commands in progress or being watched, oldest first; bounded
    std::map<Point, Value> stored;       ///< acknowledged writes, as in the store
    std::map<Point, Value> reported;     ///< the last values that the serving side reported; bounded by the catalogue
    std::uint64_t authority_shown = 0;   ///< AxisAuthority::revision of the names in its picture
    AuthorityClient latch_shown;         ///< StopLatch::by of its picture
    std::uint32_t source = 0;            ///< AxisPicture::source

    /// The ramp with which it brakes now, in increments/s^2: named by its motion, reported by its drive, or the weakest one of the site. 0:
    /// unknown.
    [[nodiscard]] std::int64_t deceleration() const noexcept {
        if (motion.runs() && motion.deceleration > 0) return motion.deceleration;
        if (const auto told = profile.feedback().rates.deceleration; told > 0) return told;
        return last_deceleration > 0 ? last_deceleration : limits.deceleration_min.value_or(0);
    }
    /// The client whose loss ends the present activity: the owner of the motion, or, at rest, the client that commanded last.
    [[nodiscard]] const AuthorityClient& owner() const noexcept { return motion.runs() ? motion.who : authority.commander(); }
};

/// One client's command in progress.
struct Client {
    std::uint64_t number = 0;
    Ticket ticket = no_ticket;
    AxisId axis = no_axis;
    CommandBody body;
    Origin origin;
    bool until_done = false;
    bool lets_go = false;     ///< a disable while the device is silent: no answer is needed for the twin to take over
    bool was_moving = false;  ///< the axis has moved since
    bool was_silent = false;  ///< the drive has been silent since: the first half of a restart
    std::size_t waiting = 0;  ///< number of orders without an answer
    bool accepted = false;    ///< all orders were accepted; the end of the motion is being watched
    Result result;            ///< the first failed answer, or the last good one
    Instant accepted_at{};
};

struct OrderRecord {
    std::uint64_t client = 0;  ///< 0 for an order of the engine itself
    AxisId axis = no_axis;
    CommandBody body;
    Origin by;  ///< the client that asked for it; of the engine's own orders the owner of the set-point that waited, or nobody
    DriveId handback = no_drive;
    Result kept;                             ///< the drive's answer while the store is writing
    Value before;                            ///< of a write: the previous value, as far as it is known
    AxisId mover = no_axis;                  ///< the axis that has the record: a native statement may move another axis of its drive
    std::optional<Motion> motion;            ///< the record that begins if the drive accepts the order
    LossCause owner_lost = LossCause::none;  ///< its client was lost while the order was on its way
    bool repeated = false;                   ///< a repeated stop, whose failure is not reported each time
    /// The drive has not answered yet.
    [[nodiscard]] bool at_drive() const noexcept { return !known(kept.value); }
};

/// The lines, drives and axes of the site in force, and the present instant. Each part of the engine works on it.
struct Machine {
    Machine(Families known, Image& pictures) : families(std::move(known)), image(pictures), site(std::make_shared<SiteState>()) {}
    [[nodiscard]] LineUnit* line(LineId id) const { return index_of(id) < lines.size() ? lines[index_of(id)].get() : nullptr; }
    [[nodiscard]] Drive* drive(DriveId id) const { return index_of(id) < drives.size() ? drives[index_of(id)].get() : nullptr; }
    [[nodiscard]] Axis* axis(AxisId id) const { return index_of(id) < axes.size() ? axes[index_of(id)].get() : nullptr; }
    /// The side that serves the drive; the real one also while none does, because a stop is tried in any case.
    [[nodiscard]] static Side* side_of(const Drive& d) { return d.serving == Presence::twin ? d.line->twins.get() : d.line->real.get(); }
    [[nodiscard]] static Speaker& speaker_of(const Side& side, const Drive& d) { return *side.speaker_of(d.family); }

    Families families;
    Image& image;
    std::shared_ptr<const SiteState> site;
    std::vector<std::unique_ptr<LineUnit>> lines;  ///< by LineId; null: removed
    std::vector<std::unique_ptr<Drive>> drives;    ///< by DriveId
    std::vector<std::unique_ptr<Axis>> axes;       ///< by AxisId
    Sides sides;
    Instant now{};
    Instant last_stir{};  ///< the last instant at which something moved, was commanded, found or lost
    Duration lease = std::chrono::seconds(30);
    Duration watchdog = std::chrono::seconds(5);
    bool closing = false;
};

/// The work without an answer: clients' commands and their orders.
struct Pending {
    std::unordered_map<std::uint64_t, std::unique_ptr<Client>> clients;  ///< by the engine's own number
    std::unordered_map<Ticket, OrderRecord> orders;                      ///< by the ticket that the adapter or the store has
    std::uint64_t next = 1;                                              ///< the next number of either
};

/// How long an `auto` drive may be silent at the start before its twin takes over, if the adapter has not reported it as absent earlier.
inline constexpr Duration first_answer_limit = std::chrono::milliseconds(1500);
inline constexpr Duration housekeeping_period = std::chrono::milliseconds(50);

}  // namespace axisgate::engine
