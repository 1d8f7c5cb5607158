// TwinBus: a line whose drives are embedded twins: a simulated CAN bus or byte line with honest wire time.
// In: frames of the host, twins, the passing of time. Out: frames at the instant at which their last bit has crossed, in order of time.
// Never has a clock: on_deadline may come late and still gives every twin and the host each event with its own instant.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gateway/core/ids.hpp"
#include "gateway/core/line.hpp"
#include "gateway/core/setup.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/wire/load_meter.hpp"
#include "gateway/wire/send_queue.hpp"

namespace axisgate {

struct TwinBusOptions {
    LineKind kind = LineKind::bytes;
    std::uint32_t bit_rate = 0;       ///< bit/s; 0: frames take no time
    std::uint8_t bits_per_byte = 10;  ///< start, data, parity and stop bits of a byte; not used on CAN
    /// Byte lines: two pairs of wires, host to drives and drives to host (RS-232, RS-422). Drives then hear the host alone. Without it
    /// there is one pair (RS-485): everybody hears everybody, and whoever sends at the same time garbles the other.
    bool full_duplex = false;
    /// Byte lines of drives that are at home on CAN: a converter stands between. It has two pairs towards the host, and what several drives
    /// say at once it sends one after the other.
    bool converter = false;
};

struct TwinBusCounters {
    std::uint64_t collisions = 0;    ///< half-duplex: transmissions that were garbled by another one
    std::uint64_t twin_dropped = 0;  ///< frames of twins that found their node's queue (256) full
    std::uint64_t foreign = 0;       ///< frames of the wrong kind: bytes on CAN, CAN frames on a byte line
};

/// CAN: one frame at a time. Frames that wait are arbitrated bit by bit as the identifiers are (lowest wins, standard before extended,
/// data before remote); every node offers its oldest frame, the host its oldest of the highest priority. Every frame counts as
/// acknowledged, also if no twin is on the bus. Bytes: a sender starts as soon as it is ready, whoever else is sending; what a twin sends
/// reaches the host while it is on the wire, in runs of `run_time` as a port's driver hands them up, the last one at its end. Twins
/// have a transmission as a whole at its end.
class TwinBus final : public Line {
public:
    /// Events handled by one on_deadline call at most; the rest follow at the next, with their own instants.
    static constexpr std::size_t max_events_per_call = 10'000;
    /// Bytes of one run to the host take this long at most (the usual latency of a USB converter), or are a single byte.
    static constexpr Duration run_time = std::chrono::milliseconds(16);

    explicit TwinBus(const TwinBusOptions& options);
    ~TwinBus() override;
    TwinBus(const TwinBus&) = delete;
    TwinBus& operator=(const TwinBus&) = delete;

    /// Puts a twin on the bus and powers it on with `memory` (empty: factory state). A twin of the same key is replaced.
    void add(DriveId key, std::unique_ptr<Twin> twin, const NonVolatile& memory, Instant now);
    /// Takes it off; a frame of it that is on the wire is completed, frames that wait are lost. May be called from an event.
    void remove(DriveId key);
    /// The twin, for looking at it (mechanics, hand, memory); nullptr if there is none. What changes it goes through the calls below,
    /// so that its frames get on the bus and its deadline is known.
    [[nodiscard]] Twin* twin(DriveId key) noexcept;
    [[nodiscard]] const Twin* twin(DriveId key) const noexcept;
    [[nodiscard]] std::size_t size() const noexcept;

    /// Twin::set_hand; also says so if there is no such twin.
    [[nodiscard]] std::string set_hand(DriveId key, const std::string& name, const Value& value, Instant now);
    /// Powers the twin on again with this memory: a restore.
    void restart(DriveId key, const NonVolatile& memory, Instant now);

    [[nodiscard]] const TwinBusCounters& counters() const noexcept { return counters_; }

    void open(LineEvents& events, Instant now) override;
    void close() override;
    bool send(const Frame& frame, Priority priority, Instant now) override;
    [[nodiscard]] Instant deadline() const override { return next_known_ ? next_.at : next_event().at; }
    void on_deadline(Instant now) override;
    [[nodiscard]] LineStatus status(Instant now) const override;

private:
    using Number = std::uint32_t;  // a node's place in nodes_, or one of:
    static constexpr Number host = 0xFFFFFFFF;
    static constexpr Number gone = 0xFFFFFFFE;  // a twin that was removed while it was sending

    struct Node;
    /// One transmission on the wire.
    struct Transmission {
        Number sender = host;
        Instant start{};
        Instant end{};
        Instant next{};                        ///< when its next bytes have crossed; `end` for the last ones
        std::uint16_t given = 0;               ///< bytes that the host has
        std::bitset<Frame::capacity> garbled;  ///< bytes that another driver has overlaid
        Frame frame;
    };
    struct Due {
        Instant at;
        Number number;
    };
    /// What comes next, and when. At the same instant an end comes first, then deadlines, then starts: whoever has something to send by
    /// then takes part.
    struct Event {
        enum class Kind : std::uint8_t { end, deadline, start };
        Instant at = never;
        Kind kind = Kind::end;
    };
    struct Ear {
        Acceptance acceptance;
        Number number;
    };
    /// A node whose queue is not empty, with what is asked of it at every event: when its oldest frame came, and how that one is
    /// arbitrated.
    struct Sender {
        Number number;
        std::uint32_t arbitration;
        Instant since;
    };

    [[nodiscard]] Number find(DriveId key) const noexcept;
    [[nodiscard]] bool sending(Number sender) const noexcept;
    [[nodiscard]] bool may_start(Number twin) const noexcept;
    [[nodiscard]] Instant next_start() const noexcept;
    [[nodiscard]] Event next_event() const noexcept;
    [[nodiscard]] Instant first_end() const noexcept;
    [[nodiscard]] std::uint16_t run_end(const Transmission& x) const noexcept;
    void give_run(Transmission& x);
    void step(Event e);
    void start(Instant t);
    void start_can(Instant t);
    void begin(Number sender, SendQueue& queue, Instant t);
    void note_sender(Number number);
    void drop_sender(Number number) noexcept;
    void garble_overlap(Transmission& a, Transmission& b) noexcept;
    void finish_one();
    void deliver_to_twins(Instant t);
    [[nodiscard]] std::span<const Number> who_receives(std::uint32_t id);
    void take(Number number, Instant t, Duration at_least = Duration::zero());
    void place(Number number, Instant due);
    void sift_up(std::size_t i) noexcept;
    void sift_down(std::size_t i) noexcept;
    [[nodiscard]] std::string text() const;

    TwinBusOptions options_;
    LineEvents* events_ = nullptr;
    bool tell_up_ = false;
    bool running_ = false;
    Instant processed_{};  // events up to here are done; nothing happens before it any more
    Event next_;           // if that is known
    bool next_known_ = false;

    std::vector<std::unique_ptr<Node>> nodes_;  // by number; null: free
    std::vector<Ear> ears_;                     // what is scanned for a frame, kept apart from the nodes so that it is dense
    std::vector<DriveId> keys_;                 // of the ears, each at the same place
    /// Who hears an identifier, as the ears were scanned for it; forgotten with each change of ears_. Sets of four by a hash of the
    /// identifier, the newest first: the few hundred identifiers of a full bus have room, in few cache lines.
    struct Hearer {
        std::uint32_t id = 0xFFFFFFFF;  ///< none
        Number number = gone;           ///< gone: nobody; host: several, the ears are asked
    };
    std::array<std::array<Hearer, 4>, 128> hearers_;
    std::vector<Number> hearing_;  // of the identifier that was asked for last
    std::vector<Due> heap_;        // twins by deadline, earliest first; nodes know their place in it
    std::vector<Sender> senders_;  // dense, for the same reason
    SendQueue host_queue_;
    std::vector<Transmission> wire_;  // CAN: at most one; bytes: at most one per sender
    Transmission done_;               // the one that is being delivered
    Instant bus_free_{};              // CAN: end of the last intermission
    Duration intermission_{};         // CAN
    Out scratch_;

    TwinBusCounters counters_;
    LineStatus status_;
    LoadMeter load_;
};

}  // namespace axisgate
