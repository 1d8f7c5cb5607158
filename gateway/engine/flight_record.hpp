// The format of recordings: every input of the engine and its consequences are records of bytes (little-endian, LEB128 numbers, zigzag for
// signed ones). Recording a frame, a turn or a picture allocates nothing. No clock is read: `at` is the instant that the engine was given.
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

/// The kind of a record. Below 32 are inputs, which determine everything else; from 32 on are their consequences.
enum class FlightKind : std::uint8_t {
    site = 1,       ///< a site came into force, or was requested: SiteInput
    command = 2,    ///< index: axis
    set_point = 3,  ///< index: axis
    client_lost = 4,
    stored = 5,
    turn = 6,         ///< Engine::on_deadline; no payload
    scan = 7,         ///< index: line
    scan_cancel = 8,  ///< index: line
    hand = 9,         ///< index: drive
    shut_down = 10,
    received = 11,       ///< a frame received from a cable; index: line
    sent = 12,           ///< a frame sent over a cable; index: line
    line_state = 13,     ///< state of a cable; index: line
    last_received = 14,  ///< the answer of a door when it was asked for the last message of a client
    look = 16,           ///< fast polling of axes begins or ends
    twin_memory = 17,    ///< a twin has adopted values: HandRecord with the whole memory; index: drive
    send_refused = 15,   ///< the line did not accept a frame: its number among the frames given to it; index: line
    twin_frame = 32,     ///< a frame on a twin bus; index: line
    handed = 33,         ///< a frame given to a line with a cable; index: line
    picture = 34,        ///< index: axis
    result = 35,         ///< index: axis
    event = 36,
    sample = 37  ///< index: axis
};
[[nodiscard]] constexpr bool is_input(FlightKind kind) noexcept { return static_cast<std::uint8_t>(kind) < 32; }
[[nodiscard]] std::string_view name_of(FlightKind kind) noexcept;

/// Added to the index of a record that a line caused during a turn, or while it was being opened. Such a record belongs to the previous
/// record without this mark.
inline constexpr std::uint16_t flight_within = 0x8000;

struct FlightRecord {
    FlightKind kind = FlightKind::turn;
    std::uint16_t index = 0xFFFF;  ///< of the line, drive or axis; 0xFFFF: none
    Instant at{};
    std::span<const char> payload;
};

/// The inputs of the engine when a site was applied: sufficient to start a replay from nothing.
struct SiteInput {
    Site site;
    SiteMemory memory;
    std::uint64_t revision = 0;
    bool at_once = true;  ///< apply_site; otherwise change_site
    Duration lease{}, watchdog{};
    std::vector<DescriptionText> descriptions;  ///< the descriptions that its drives name
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
    Duration age{};  ///< from the drive's report to the record
    bool operator==(const PictureRecord&) const = default;
};
[[nodiscard]] PictureRecord picture_record(const AxisPicture& p, Instant now) noexcept;

struct FrameRecord {
    bool to_drive = false;
    Ticket cause = no_ticket;  ///< the client's command for which it was sent; none for a poll or an action of the gateway itself
    Frame frame;
};

/// The text for a command: its ticket without the door's number.
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

/// Decodes a payload; empty if it is damaged.
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

/// The site in a recording: a JSON document with its memory. `read_site_input` needs the families that can read it.
[[nodiscard]] std::string pack_site(const SiteInput& site);
[[nodiscard]] std::optional<SiteInput> read_site_input(std::span<const char> payload, const Families& families, std::string& fault);

/// The content of a record as one line for people.
[[nodiscard]] std::string to_text(const FlightRecord& record);

/// Receives the inputs and outputs of the engine as records. A recorder derives from it and implements `take`.
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
    void adopt(DriveId drive, const NonVolatile& memory, const Origin& origin, Instant now);
    void shut_down(Instant now) { take({FlightKind::shut_down, 0xFFFF, now, {}}); }
    void line_state(LineId line, bool up, const std::string& why, Instant now);
    void last_received(std::optional<Instant> at, Instant now);
    void send_refused(LineId line, Instant now);
    // inputs on a cable, consequences on a twin bus
    void frame(LineId line, const Frame& frame, bool to_drive, bool twin);

    // consequences
    // `command` is the command for which the frame is sent; none for a poll, or for the cause of the current call (FlightCause).
    void handed(LineId line, const Frame& frame, bool twin, Ticket command, Instant now);
    void picture(AxisId axis, const AxisPicture& p, Instant now);
    void result(const Result& r, Instant now);
    void event(const Event& e, Instant now);
    void sample(const Sample& s, Instant now);

    /// A turn is in progress, or a site is coming into force.
    void set_within(bool on) noexcept { within_ = on; }
    /// Frames that are sent until the next call are sent for this client's command.
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
    /// The newest frames of commands that wait in a line's queue.
    struct Waiting {
        LineId line = no_line;
        Ticket cause = no_ticket;
        Frame frame;
    };
    static constexpr std::size_t most_waiting = 16;
    std::vector<Waiting> waiting_;
    std::vector<std::uint64_t> handed_;  ///< by line
};

/// During its lifetime, sent frames are recorded as sent for this command.
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

/// During its lifetime, calls of lines are recorded as part of a turn, or of a site that comes into force.
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

/// Records one behind the other, in chunks of bounded size. Each chunk begins with an absolute instant.
class FlightLog {
public:
    static constexpr std::size_t chunk_bytes = 64 * 1024;
    struct Chunk {
        std::string bytes;
        Instant first{}, last{};
        std::uint64_t records = 0, outcomes = 0;
    };
    using Chunks = std::vector<std::shared_ptr<const Chunk>>;

    /// `bound` is in bytes. Beyond it the oldest chunk is dropped (`keep_newest`), or all chunks, and nothing more is recorded.
    FlightLog(std::size_t bound, bool keep_newest) : bound_(bound), keep_newest_(keep_newest) {}
    void add(const FlightRecord& r);
    [[nodiscard]] Chunks chunks() const;  ///< the chunks are shared with this log, so this is cheap
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
    [[nodiscard]] std::uint64_t gone() const noexcept { return gone_; }  ///< number of dropped records
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

/// Reads the records of a FlightLog, chunk by chunk.
class FlightReader {
public:
    explicit FlightReader(std::span<const char> bytes) : rest_(bytes) {}
    /// Empty at the end, or if the data are damaged.
    [[nodiscard]] std::optional<FlightRecord> next();
    [[nodiscard]] bool damaged() const noexcept { return damaged_; }

private:
    std::span<const char> rest_;
    Instant last_{};
    bool damaged_ = false;
};

}  // namespace axisgate
