// A line whose drives are embedded twins: a simulated CAN bus or byte line with real wire times. Frames arrive at the instant of their last
// bit, in order of time. There is no clock: on_deadline may be late and still gives every twin and the host each event with its own
// instant.
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
    /// Byte lines with two pairs of wires, host to drives and drives to host (RS-232, RS-422): drives receive only the host. Without it
    /// there is one pair (RS-485): every node receives every other, and simultaneous transmissions corrupt each other.
    bool full_duplex = false;
    /// Byte lines of drives that have a CAN interface: a converter is in between. It has two pairs towards the host, and sends simultaneous
    /// messages of several drives one after the other.
    bool converter = false;
};

struct TwinBusCounters {
    std::uint64_t collisions = 0;    ///< half-duplex: transmissions that another one has corrupted
    std::uint64_t twin_dropped = 0;  ///< frames of twins that found their node's queue (256) full
    std::uint64_t foreign = 0;       ///< frames of the wrong kind: bytes on CAN, CAN frames on a byte line
};

/// CAN: one frame at a time. Waiting frames are arbitrated bit by bit by identifier (lowest wins, standard before extended, data before
/// remote); every node offers its oldest frame, the host its oldest of the highest priority. Every frame counts as acknowledged, also if no
/// twin is on the bus. Bytes: a sender starts as soon as it is ready, even while others are sending. Bytes of a twin reach the host during
/// the transmission, in runs of `run_time` as from a port's driver, the last run at its end. Twins receive a transmission as a whole at its
/// end.
class TwinBus final : public Line {
public:
    /// Limit of events that one call of on_deadline handles; the rest follow at the next call, with their own instants.
    static constexpr std::size_t max_events_per_call = 10'000;
    /// The longest duration of one run of bytes to the host (the usual latency of a USB converter), unless it is a single byte.
    static constexpr Duration run_time = std::chrono::milliseconds(16);

    explicit TwinBus(const TwinBusOptions& options);
    ~TwinBus() override;
    TwinBus(const TwinBus&) = delete;
    TwinBus& operator=(const TwinBus&) = delete;

    /// Connects a twin and switches it on with `memory` (empty: factory state). A twin of the same key is replaced.
    void add(DriveId key, std::unique_ptr<Twin> twin, const NonVolatile& memory, Instant now);
    /// Disconnects the twin; its frame on the wire is completed, waiting frames are lost. May be called from an event.
    void remove(DriveId key);
    /// The twin, for inspection (mechanics, hand, memory); nullptr if there is none. Changes must use the functions below, so that its
    /// frames reach the bus and its deadline is known.
    [[nodiscard]] Twin* twin(DriveId key) noexcept;
    [[nodiscard]] const Twin* twin(DriveId key) const noexcept;
    [[nodiscard]] std::size_t size() const noexcept;

    /// Twin::set_hand; also returns a text if there is no such twin.
    [[nodiscard]] std::string set_hand(DriveId key, const std::string& name, const Value& value, Instant now);
    /// Restarts the twin with this memory, for a restore.
    void restart(DriveId key, const NonVolatile& memory, Instant now);

    [[nodiscard]] const TwinBusCounters& counters() const noexcept { return counters_; }

    void open(LineEvents& events, Instant now) override;
    void close() override;
    bool send(const Frame& frame, Priority priority, Instant now) override;
    [[nodiscard]] Instant deadline() const override { return next_known_ ? next_.at : next_event().at; }
    void on_deadline(Instant now) override;
    [[nodiscard]] LineStatus status(Instant now) const override;

private:
    using Number = std::uint32_t;  // index of a node in nodes_, or one of:
    static constexpr Number host = 0xFFFFFFFF;
    static constexpr Number gone = 0xFFFFFFFE;  // a twin that was removed while it was sending

    struct Node;
    /// One transmission on the wire.
    struct Transmission {
        Number sender = host;
        Instant start{};
        Instant end{};
        Instant next{};                        ///< when its next bytes are complete; `end` for the last ones
        std::uint16_t given = 0;               ///< number of bytes that the host has
        std::bitset<Frame::capacity> garbled;  ///< bytes that another driver has corrupted
        Frame frame;
    };
    struct Due {
        Instant at;
        Number number;
    };
    /// The next event and its instant. At the same instant an end comes first, then deadlines, then starts: every node that has something
    /// to send by then takes part.
    struct Event {
        enum class Kind : std::uint8_t { end, deadline, start };
        Instant at = never;
        Kind kind = Kind::end;
    };
    struct Ear {
        Acceptance acceptance;
        Number number;
    };
    /// A node whose queue is not empty, with the data that every event needs: when its oldest frame came, and how that frame is arbitrated.
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
    Instant processed_{};  // events up to this instant are done; nothing happens before it any more
    Event next_;           // if it is known
    bool next_known_ = false;

    std::vector<std::unique_ptr<Node>> nodes_;  // by number; null: free
    std::vector<Ear> ears_;                     // the data that each frame is compared with, kept apart from the nodes so that they are
                                                // dense
    std::vector<DriveId> keys_;                 // keys of ears_, by the same index
    /// The receivers of an identifier, as found in ears_; cleared with each change of ears_. Sets of four by a hash of the identifier, the
    /// newest first: the few hundred identifiers of a full bus fit into few cache lines.
    struct Hearer {
        std::uint32_t id = 0xFFFFFFFF;  ///< none
        Number number = gone;           ///< gone: no receiver; host: several, ears_ must be searched
    };
    std::array<std::array<Hearer, 4>, 128> hearers_;
    std::vector<Number> hearing_;  // receivers of the last identifier
    std::vector<Due> heap_;        // twins by deadline, earliest first; nodes know their index in it
    std::vector<Sender> senders_;  // dense, for the same reason
    SendQueue host_queue_;
    std::vector<Transmission> wire_;  // CAN: at most one; bytes: at most one per sender
    Transmission done_;               // the transmission that is being delivered
    Instant bus_free_{};              // CAN: end of the last intermission
    Duration intermission_{};         // CAN
    Out scratch_;

    TwinBusCounters counters_;
    LineStatus status_;
    LoadMeter load_;
};

}  // namespace axisgate
