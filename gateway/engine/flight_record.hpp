// Flight record: what the engine was given and what came of it, as plain records of bytes: the language of recordings.
// In: calls of the engine, each once. Out: records, handed on; and read back. Little-endian, numbers as LEB128, signed ones zigzag.
// Never allocates for a frame, a turn or a picture, and never looks at a clock: `at` is the instant that the engine was told.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "gateway/axis/image.hpp"
#include "gateway/core/event.hpp"
#include "gateway/core/frame.hpp"
#include "gateway/engine/engine.hpp"

namespace axisgate {

/// What a record is. Below 32: inputs, from which everything else follows; from 32 on: what came of them.
enum class FlightKind : std::uint8_t {
    site = 1,       ///< a site came into force, or shall: SiteInput
    command = 2,    ///< index: axis
    set_point = 3,  ///< index: axis
    client_lost = 4,
    stored = 5,
    turn = 6,         ///< Engine::on_deadline; no payload
    scan = 7,         ///< index: line
    scan_cancel = 8,  ///< index: line
    hand = 9,         ///< index: drive
    shut_down = 10,
    received = 11,       ///< a frame from a cable; index: line
    sent = 12,           ///< a frame has left by a cable; index: line
    line_state = 13,     ///< of a cable; index: line
    last_received = 14,  ///< the answer of a door to the question when a client was heard last
    look = 16,           ///< axes are looked at closely, or no more
    send_refused = 15,   ///< the line did not take a frame: its number among those handed to it; index: line
    twin_frame = 32,     ///< a frame on a twin bus; index: line
    handed = 33,         ///< a frame for a cable, handed to its line; index: line
    picture = 34,        ///< index: axis
    result = 35,         ///< index: axis
    event = 36,
    sample = 37  ///< index: axis
};
[[nodiscard]] constexpr bool is_input(FlightKind kind) noexcept { return static_cast<std::uint8_t>(kind) < 32; }
[[nodiscard]] std::string_view name_of(FlightKind kind) noexcept;

/// In the index of what a line told from inside a turn, or from inside its opening: it belongs to the record before it that is no such.
inline constexpr std::uint16_t flight_within = 0x8000;

struct FlightRecord {
    FlightKind kind = FlightKind::turn;
    std::uint16_t index = 0xFFFF;  ///< of the line, drive or axis; 0xFFFF: none
    Instant at{};
    std::span<const char> payload;
};

/// What the engine was given when a site came: enough to begin with nothing else.
struct SiteInput {
    Site site;
    SiteMemory memory;
    std::uint64_t revision = 0;
    bool at_once = true;  ///< apply_site; else change_site
    Duration lease{}, watchdog{};
    std::vector<DescriptionText> descriptions;  ///< that its drives name
};

/// The part of an AxisPicture that is recorded.
struct PictureRecord {
    std::int64_t position = 0, demand = 0, velocity = 0;
    std::uint32_t native_status = 0;
    std::uint16_t error_code = 0, statusword = 0, flags = 0, fail_safe_cause = 0;
    std::int16_t mode_display = 0;
    DemandSource demand_source = DemandSource::none;
    Presence presence = Presence::offline;
    bool current = false;
    Duration age{};  ///< from the drive's word to the record
    bool operator==(const PictureRecord&) const = default;
};
[[nodiscard]] PictureRecord picture_record(const AxisPicture& p, Instant now) noexcept;

struct FrameRecord {
    bool to_drive = false;
    Ticket cause = no_ticket;  ///< the client's command for which it was sent; none: a poll, or the gateway's own doing
    Frame frame;
};

/// How a command is called in texts: without the place in which its ticket was given out.
[[nodiscard]] constexpr std::uint64_t ticket_number(Ticket ticket) noexcept { return ticket & 0xFFFFFFFFFFFFFFull; }

struct CommandRecord {
    Command command;
};
struct SetPointRecord {
    SetPoint set_point;
};
struct LossRecord {
    AuthorityClient who;
    LossCause cause = LossCause::none;
};
struct StoredRecord {
    Ticket order = no_ticket;
    std::string fault;
};
struct HandRecord {
    std::vector<std::pair<std::string, Value>> items;
    Origin origin;
};
struct LookRecord {
    std::vector<AxisId> axes;
    Duration period{};
    Instant until{};
};
struct LineStateRecord {
    bool up = false;
    std::string why;
};

/// Reads payloads back; nothing: it is damaged.
template <class T>
[[nodiscard]] std::optional<T> unpack(std::span<const char> payload);
extern template std::optional<PictureRecord> unpack(std::span<const char>);
extern template std::optional<FrameRecord> unpack(std::span<const char>);
extern template std::optional<CommandRecord> unpack(std::span<const char>);
extern template std::optional<SetPointRecord> unpack(std::span<const char>);
extern template std::optional<LossRecord> unpack(std::span<const char>);
extern template std::optional<StoredRecord> unpack(std::span<const char>);
extern template std::optional<HandRecord> unpack(std::span<const char>);
extern template std::optional<LineStateRecord> unpack(std::span<const char>);
extern template std::optional<LookRecord> unpack(std::span<const char>);
extern template std::optional<ScanWish> unpack(std::span<const char>);
extern template std::optional<Result> unpack(std::span<const char>);
extern template std::optional<Event> unpack(std::span<const char>);
extern template std::optional<Sample> unpack(std::span<const char>);
extern template std::optional<std::int64_t> unpack(std::span<const char>);

/// A site as it lies in a recording: a JSON document with its memory. `read_site_input` needs the families that can read it.
[[nodiscard]] std::string pack_site(const SiteInput& site);
[[nodiscard]] std::optional<SiteInput> read_site_input(std::span<const char> payload, const Families& families, std::string& fault);

/// What a record says, for people: one line.
[[nodiscard]] std::string to_text(const FlightRecord& record);

/// The engine tells it what it is given and what it tells. Whoever wants to record derives from it and takes the records.
class FlightTap {
public:
    virtual ~FlightTap() = default;

    // inputs
    void site(std::shared_ptr<const SiteInput> input, Instant now) { take_site(std::move(input), now); }
    void command(const Command& c, Instant now);
    void set_point(const SetPoint& p, Instant now);
    void client_lost(const AuthorityClient& who, LossCause cause, Instant now);
    void stored(Ticket order, const std::string& fault, Instant now);
    void turn(Instant now) { take({FlightKind::turn, 0xFFFF, now, {}}); }
    void scan(LineId line, const ScanWish& wish, Instant now);
    void look(const LookRecord& look, Instant now);
    void scan_cancel(LineId line, Instant now) { take({FlightKind::scan_cancel, index_of(line), now, {}}); }
    void hand(DriveId drive, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin, Instant now);
    void shut_down(Instant now) { take({FlightKind::shut_down, 0xFFFF, now, {}}); }
    void line_state(LineId line, bool up, const std::string& why, Instant now);
    void last_received(std::optional<Instant> at, Instant now);
    void send_refused(LineId line, Instant now);
    // inputs on a cable, outcomes on a twin bus
    void frame(LineId line, const Frame& frame, bool to_drive, bool twin);

    // what came of it
    /// `command`: for whose it is sent; none: of a poll, or what the call in hand is for (FlightCause).
    void handed(LineId line, const Frame& frame, bool twin, Ticket command, Instant now);
    void picture(AxisId axis, const AxisPicture& p, Instant now);
    void result(const Result& r, Instant now);
    void event(const Event& e, Instant now);
    void sample(const Sample& s, Instant now);

    /// A turn, or a site's coming into force, is under way.
    void set_within(bool on) noexcept { within_ = on; }
    /// What is sent until it is called again is sent for this command of a client.
    void set_cause(Ticket ticket) noexcept { cause_ = ticket; }
    [[nodiscard]] Ticket cause() const noexcept { return cause_; }

protected:
    virtual void take(const FlightRecord& record) = 0;
    virtual void take_site(std::shared_ptr<const SiteInput> input, Instant now) = 0;

private:
    void give(FlightKind kind, std::uint16_t index, Instant at) { take({kind, index, at, scratch_}); }

    std::string scratch_;
    [[nodiscard]] std::uint16_t place_of(LineId line) const noexcept {
        return static_cast<std::uint16_t>(index_of(line) | (within_ ? flight_within : 0));
    }
    Ticket cause_ = no_ticket;
    bool within_ = false;
    /// Frames of commands that wait in a line's queue: the newest few.
    struct Waiting {
        LineId line = no_line;
        Ticket cause = no_ticket;
        Frame frame;
    };
    static constexpr std::size_t most_waiting = 16;
    std::vector<Waiting> waiting_;
    std::vector<std::uint64_t> handed_;  ///< by line
};

/// While it lives, what is sent is sent for this command.
class FlightCause {
public:
    FlightCause(FlightTap* tap, Ticket ticket) noexcept : tap_(tap), before_(tap ? tap->cause() : no_ticket) {
        if (tap_) tap_->set_cause(ticket);
    }
    ~FlightCause() {
        if (tap_) tap_->set_cause(before_);
    }
    FlightCause(const FlightCause&) = delete;
    FlightCause& operator=(const FlightCause&) = delete;

private:
    FlightTap* tap_;
    Ticket before_;
};

/// While it lives, what lines tell is told from inside a turn, or while a site comes into force.
class FlightWithin {
public:
    explicit FlightWithin(FlightTap* tap) noexcept : tap_(tap) {
        if (tap_) tap_->set_within(true);
    }
    ~FlightWithin() {
        if (tap_) tap_->set_within(false);
    }
    FlightWithin(const FlightWithin&) = delete;
    FlightWithin& operator=(const FlightWithin&) = delete;

private:
    FlightTap* tap_;
};

/// Records one behind the other, in chunks of bounded size; each chunk begins with an instant of its own.
class FlightLog {
public:
    static constexpr std::size_t chunk_bytes = 64 * 1024;
    struct Chunk {
        std::string bytes;
        Instant first{}, last{};
        std::uint64_t records = 0, outcomes = 0;
    };
    using Chunks = std::vector<std::shared_ptr<const Chunk>>;

    /// `bound`: bytes; beyond it the oldest chunk goes (`keep_newest`), or all of it, and nothing is kept any more.
    FlightLog(std::size_t bound, bool keep_newest) : bound_(bound), keep_newest_(keep_newest) {}
    void add(const FlightRecord& r);
    [[nodiscard]] Chunks chunks() const;  ///< shared with this log: cheap
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
    [[nodiscard]] std::uint64_t gone() const noexcept { return gone_; }  ///< records that were let go
    [[nodiscard]] std::uint64_t gone_outcomes() const noexcept { return gone_outcomes_; }
    [[nodiscard]] bool overflowed() const noexcept { return overflowed_; }
    void give_up() noexcept;

private:
    std::size_t bound_;
    bool keep_newest_;
    bool overflowed_ = false;
    std::size_t bytes_ = 0;
    std::uint64_t gone_ = 0, gone_outcomes_ = 0;
    Instant last_{};
    std::vector<std::shared_ptr<const Chunk>> whole_;
    std::shared_ptr<Chunk> open_;
};

/// Reads what FlightLog wrote, a chunk behind the other.
class FlightReader {
public:
    explicit FlightReader(std::span<const char> bytes) : rest_(bytes) {}
    /// Nothing: the end, or damage.
    [[nodiscard]] std::optional<FlightRecord> next();
    [[nodiscard]] bool damaged() const noexcept { return damaged_; }

private:
    std::span<const char> rest_;
    Instant last_{};
    bool damaged_ = false;
};

}  // namespace axisgate
