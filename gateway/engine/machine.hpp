// Machine: the engine's records of lines, drives, axes and waiting clients, and all of them together.
// In and out: nothing; plain records with the one event handler that a line needs. Each part of the engine is given what it works on.
// Never used outside the engine.
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

/// One family's adapter on a side, for its drives and those of families that it serves: several share a CAN line, each with the frames that
/// its identifiers hold.
struct Speaker {
    Speaker(Side& s, FamilyEntry f, std::uint8_t n) : side(s), family(f), number(n) {}
    Side& side;
    FamilyEntry family;
    std::uint8_t number;  ///< Frame::sender of what it sends
    std::unique_ptr<Adapter> adapter;
    std::vector<CanIdentifiers> identifiers;
    bool receives_all = true;
    std::vector<DriveSetup> probes;              ///< addresses that a scan asks now
    std::optional<AdapterCounters> before_scan;  ///< what it had counted when the scan that runs came to it
    AdapterCounters scanned;                     ///< while scans ran that are over

    /// What it counted while scans ran, the one that runs among them.
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

/// Whether drives of one of these families are this adapter's.
[[nodiscard]] inline bool serves_any(const Speaker& s, std::span<const FamilyEntry> families) {
    return std::ranges::any_of(families, [&](const FamilyEntry& f) { return &serving_family(*f.family) == s.family.family; });
}

/// The adapters of one line with what they talk on: the real line, or the twin bus beside it.
struct Side final : LineEvents {
    Side(Routing& r, LineUnit& u, bool is_twin) : routing(r), unit(u), twin(is_twin) {}
    Routing& routing;
    LineUnit& unit;
    bool twin;
    bool up = false;
    bool tried = false;  ///< has reported its state at least once
    std::string why = "not opened yet";
    std::vector<std::unique_ptr<Speaker>> speakers;  ///< by family; most_families_on_a_line at most, and those of a scan
    std::unique_ptr<Line> line;
    std::uint64_t unclaimed = 0;  ///< CAN frames that none of them hears
    TwinBus* bus = nullptr;       ///< `line` seen as what it is, on the twin's side
    /// Whoever calls its line or an adapter of it says so: its deadline is asked for anew. drain() does it for most.
    void touched() noexcept;
    [[nodiscard]] Instant deadline() const { return std::min(line->deadline(), adapters_deadline()); }
    [[nodiscard]] Instant adapters_deadline() const {
        Instant due = never;
        for (const auto& s : speakers)
            due = std::min(due, s->adapter->deadline());
        return due;
    }
    class Sides* among = nullptr;  ///< where its deadline is kept, and at which place
    std::size_t place = 0;
    [[nodiscard]] Speaker* speaker_of(const FamilyEntry& family) const noexcept {
        const Family& serves = serving_family(*family.family);
        const auto it = std::ranges::find_if(speakers, [&](const auto& s) { return s->family.family == &serves; });
        return it == speakers.end() ? nullptr : it->get();
    }

    void on_frame(const Frame& frame) override;
    void on_line_state(bool now_up, const std::string& text) override;
    void on_sent(const Frame& frame) override;

    /// One command at a time is followed until its frame has left, for the histogram; those that come meanwhile are not. Real lines alone.
    struct Followed {
        Ticket ticket = no_ticket;  ///< none: the next command is
        Instant since{};
        bool handed_on = false;  ///< `frame` is in the line's queue
        Frame frame;
    } followed;
};

/// All sides that exist, in the order in which they came, and a heap of their deadlines: a turn of the engine visits those alone that are
/// due, and asks those alone that were touched.
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
        asked_for_.push_back(place);  // room for all is kept
    }
    [[nodiscard]] Instant earliest() {
        ask();
        return heap_.empty() ? never : heap_.front().at;
    }
    /// The same where what simulated drives say may be seen to so much later on the sides that wait; what adapters do is due when it is.
    [[nodiscard]] Instant earliest(Duration twins_wait, auto&& waits) {
        ask();
        Instant t = never;
        for (const auto [at, place] : heap_)
            t = std::min(t, all_[place]->twin && at < t && waits(*all_[place]) ? std::min(at + twins_wait, adapters_due_[place]) : at);
        return t;
    }
    /// The first one at this place or behind it whose deadline has come; nullptr: none.
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
    void look(std::size_t at, std::size_t from, Instant now, std::size_t& first) const {  // at one that is due
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
    std::vector<Due> heap_;              ///< the earliest first
    std::vector<std::size_t> in_heap_;   ///< by place
    std::vector<Instant> adapters_due_;  ///< by place
    std::vector<char> to_ask_;
    std::vector<std::size_t> asked_for_;
};
inline void Side::touched() noexcept {
    if (among) among->touched(place);
}

/// One search for drives on a line; kept for its report until the next. Its families are searched for side by side.
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
        std::size_t report = 0;            ///< its place in ScanReport::parts
        std::vector<std::string> waiting;  ///< the next one at the back
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
    FamilyEntry family;                 ///< of those of its drives that name none; nullptrs if all do
    std::vector<FamilyEntry> families;  ///< of all that the site has on it
    LineKind kind = LineKind::bytes;
    std::unique_ptr<Side> real;   ///< null on a line with the URI "twin"
    std::unique_ptr<Side> twins;  ///< null while no drive is simulated
    std::shared_ptr<FrameLog> log;
    std::vector<DriveId> drives;
    std::unique_ptr<Scan> scan;    ///< null: never scanned
    AdapterCounters scanned_gone;  ///< by speakers that only a scan brought in
    Duration stale_after{};
};

struct Drive {
    DriveSpec spec;
    DriveId id = no_drive;
    LineUnit* line = nullptr;
    FamilyEntry family;
    std::shared_ptr<const Catalogue> catalogue;  ///< its own, or its family's page
    std::vector<AxisId> axes;
    Presence serving = Presence::offline;  ///< whose word counts: the device's, the twin's, nobody's
    /// Whether who serves it answers.
    [[nodiscard]] bool answers() const noexcept {
        return serving == Presence::twin ? twin_online : serving == Presence::device && device_online;
    }
    bool device_online = false, twin_online = false;
    bool device_lost_while_commanded = false;
    Instant waiting_since{};  ///< when we began to wait for the device
    DriveLink device_link, twin_link;
    std::string why = "not seen yet";
    int twin_axes = 1;  ///< that the running twin was built with
    std::uint64_t memory_revision = 0;
    NonVolatile memory;  ///< what the twin starts from
    /// The device is back: its parameters are read and compared before it gets its axes again.
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
    Motion motion;                  ///< what moves it
    std::size_t motions_asked = 0;  ///< orders on their way that make another record if the drive takes them
    Motion asked;                   ///< the newest of those: the drive may carry it out before its answer is here
    std::optional<Motion>
        suspected;  ///< of an order that left and was answered as failed, or that a stop came after: it may begin all the same
    std::optional<Motion> statement;  ///< whose motion begins if the axis moves without an order: it came after an unread statement
    Origin waiting;                   ///< whose set-point waits behind the running motion, or waited last
    Stops stops;
    StopLatch latch;
    Watch watch;
    Instant moves_since{};               ///< without a record, or against its state; the beginning of time: it does not
    std::int64_t speed_then = 0;         ///< at that instant, increments/s
    bool contradicts = false;            ///< it moves against its state, and an alarm has told of it
    std::optional<Move> prepared;        ///< taken by the drive, starts with StartTogether
    std::int64_t last_deceleration = 0;  ///< of the last move that named one and was taken: a drive keeps it; 0: not known
    /// Set-points that one client renews: what becomes of them. The motion that they make is `motion`.
    struct Stream {
        bool on = false;
        SetPoint::Mode mode = SetPoint::Mode::position;
        AuthorityClient who;
        Origin origin;
        std::int64_t value = 0;  ///< of the newest one that was handed to the drive
        Instant renewed{};       ///< by one that was handed to the drive: a refused one keeps nothing alive
        Duration good_for{};
        std::uint32_t taken = 0, refused = 0;
        Reason refusal = Reason::none;  ///< of the newest one, or of the stream
        Instant tell_again_at{};
        bool unpublished = false;  ///< the present refusal has not been told in words
        AuthorityClient ended_by;  ///< whose stream was the last; it must pause before its next one
        Instant ended_received{};  ///< when it sent one last, since then
        Reason ended_for = Reason::none;
        std::string ended_why;
    } stream;
    Ticket setpoint_ticket =
        no_ticket;            ///< the set-point that came last by a control word: it may wait and begin later, without its client
    Instant leaving_until{};  ///< a site change takes it away: until then nothing begins here any more
    bool at_limit = false;    ///< a motion was ended at a limit, and none has begun since
    AxisAuthority authority;
    std::optional<AtLoss> lost_line;  ///< its drive went silent while this axis was commanded, and has not spoken since
    Duration look_period{};           ///< zero: asked in the line's rhythm
    Instant look_until{};
    bool stale = true;
    bool was_fault = false;
    bool was_safe_stop = false;
    std::string homing_why;  ///< why the last search for a zero failed, by the adapter's notice
    std::uint16_t last_error = 0;
    std::vector<std::uint64_t> clients;  ///< commands on their way or being watched, oldest first; bounded
    std::map<Point, Value> stored;       ///< acknowledged writes, as the store has them
    std::map<Point, Value> reported;     ///< what who speaks for it said last; bounded by the catalogue
    std::uint64_t authority_shown = 0;   ///< AxisAuthority::revision whose names stand in its picture
    AuthorityClient latch_shown;         ///< StopLatch::by that stands in its picture
    std::uint32_t source = 0;            ///< AxisPicture::source

    /// The ramp with which it brakes now, increments/s^2: named by its motion, told by its drive, or the site's worst. 0: nobody knows.
    [[nodiscard]] std::int64_t deceleration() const noexcept {
        if (motion.runs() && motion.deceleration > 0) return motion.deceleration;
        if (const auto told = profile.feedback().rates.deceleration; told > 0) return told;
        return last_deceleration > 0 ? last_deceleration : limits.deceleration_min.value_or(0);
    }
    /// Whose loss ends what it does: the owner of its motion; of an axis at rest, who commanded it last.
    [[nodiscard]] const AuthorityClient& owner() const noexcept { return motion.runs() ? motion.who : authority.commander(); }
};

/// One client's command on its way.
struct Client {
    std::uint64_t number = 0;
    Ticket ticket = no_ticket;
    AxisId axis = no_axis;
    CommandBody body;
    Origin origin;
    bool until_done = false;
    bool lets_go = false;     ///< a disable whose device is silent: nobody need hear it for the twin to take over
    bool was_moving = false;  ///< its axis has moved since
    bool was_silent = false;  ///< its drive has been silent since: the first half of a restart
    std::size_t waiting = 0;  ///< orders without an answer
    bool accepted = false;    ///< all orders were taken; the end of the motion is being watched
    Result result;            ///< the first bad answer, or the last good one
    Instant accepted_at{};
};

struct OrderRecord {
    std::uint64_t client = 0;  ///< 0: of the engine's own making
    AxisId axis = no_axis;
    CommandBody body;
    DriveId handback = no_drive;
    Result kept;                             ///< what the drive said, while the store works
    Value before;                            ///< of a write: what was there, as far as it is known
    AxisId mover = no_axis;                  ///< whose record: a native statement may move another axis of its drive
    std::optional<Motion> motion;            ///< the record that it makes if the drive takes it
    LossCause owner_lost = LossCause::none;  ///< its client was lost while it was on its way
    bool repeated = false;                   ///< a stop that is said again: its failure is not told each time
    /// Its drive has not answered yet.
    [[nodiscard]] bool at_drive() const noexcept { return !known(kept.value); }
};

/// All that is there: lines, drives and axes of the site in force, and the present moment. Each part of the engine works on it.
struct Machine {
    Machine(Families known, Image& pictures) : families(std::move(known)), image(pictures), site(std::make_shared<SiteState>()) {}
    [[nodiscard]] LineUnit* line(LineId id) const { return index_of(id) < lines.size() ? lines[index_of(id)].get() : nullptr; }
    [[nodiscard]] Drive* drive(DriveId id) const { return index_of(id) < drives.size() ? drives[index_of(id)].get() : nullptr; }
    [[nodiscard]] Axis* axis(AxisId id) const { return index_of(id) < axes.size() ? axes[index_of(id)].get() : nullptr; }
    /// Of who serves the drive; the real one also while nobody does: a stop is tried all the same.
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
    Instant last_stir{};  ///< when something moved, was commanded, found or lost
    Duration lease = std::chrono::seconds(30);
    Duration watchdog = std::chrono::seconds(5);
    bool closing = false;
};

/// What has no answer yet: clients' commands, and the orders that they came to.
struct Pending {
    std::unordered_map<std::uint64_t, std::unique_ptr<Client>> clients;  ///< by own number
    std::unordered_map<Ticket, OrderRecord> orders;                      ///< by the ticket that the adapter or the store has
    std::uint64_t next = 1;                                              ///< numbers of both
};

/// How long an `auto` drive may be silent at the start before its twin takes over, if the adapter has not given it up earlier.
inline constexpr Duration first_answer_limit = std::chrono::milliseconds(1500);
inline constexpr Duration housekeeping_period = std::chrono::milliseconds(50);

}  // namespace axisgate::engine
