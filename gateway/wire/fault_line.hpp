// A line with deliberate faults around another line: it loses, doubles, corrupts, shortens, delays, swaps and inserts frames, and can be
// cut. All randomness comes from the seed: the same seed and the same calls cause the same faults.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "gateway/core/line.hpp"

namespace axisgate {

/// The faults of one direction. Probabilities are per frame, 0..1, and independent of each other.
struct FaultRates {
    double loss = 0;
    double duplicate = 0;  ///< the frame is sent twice
    double flip = 0;       ///< one bit of its content is inverted
    double truncate = 0;   ///< the frame is truncated
    double insert = 0;     ///< bytes: 1..8 foreign bytes in the frame; CAN: a foreign frame before it
    double delay = 0;      ///< the frame is late, and so are all frames behind it, because the order on a wire is kept
    Duration delay_max{};  ///< by more than zero and at most this
    /// CAN only: the next frame of the same direction overtakes it, as between two mailboxes of a controller. If none comes within
    /// FaultLine::overtaken_at_most, it is sent. Bytes keep their order on every wire.
    double reorder = 0;
    Duration drift{};      ///< a line that becomes slower: all frames are later by this for every second since the rates were set
    Duration drift_max{};  ///< but by no more than this
};

struct FaultPlan {
    std::uint64_t seed = 1;
    FaultRates to_drive;
    FaultRates from_drive;
};

struct FaultCounters {
    std::uint64_t lost = 0, duplicated = 0, flipped = 0, truncated = 0, inserted = 0, delayed = 0, reordered = 0;
    std::uint64_t swallowed = 0;   ///< lost while the line was cut
    std::uint64_t overflowed = 0;  ///< more than FaultLine::max_delayed frames were late in one direction
};

class FaultLine final : public Line, private LineEvents {
public:
    static constexpr std::size_t max_delayed = 1024;
    static constexpr Duration overtaken_at_most = std::chrono::milliseconds(2);

    FaultLine(std::unique_ptr<Line> inner, const FaultPlan& plan);

    /// New rates from the next frame on; the random sequence continues.
    void set_rates(const FaultRates& to_drive, const FaultRates& from_drive) noexcept;
    /// Cuts the cable; the owner is informed at the next on_deadline. Frames of both directions are lost, including delayed ones. Frames
    /// that the inner line has accepted already are still sent, and not reported.
    void cut(Instant now, std::string why = "cut on purpose");
    /// CAN: the controller has seen too many errors and leaves the bus. It reports this, the line is down, and returns by itself.
    void bus_off(Instant now, Duration pause);
    /// Connects the cable again; the line is up as soon as the inner line is.
    void heal(Instant now);
    [[nodiscard]] bool is_cut() const noexcept { return cut_; }

    [[nodiscard]] const FaultCounters& counters() const noexcept { return counters_; }
    [[nodiscard]] Line& inner() noexcept { return *inner_; }

    void open(LineEvents& events, Instant now) override;
    void close() override;
    bool send(const Frame& frame, Priority priority, Instant now) override;
    [[nodiscard]] Instant deadline() const override;
    void on_deadline(Instant now) override;
    /// The status of the inner line, with this line's own state and losses.
    [[nodiscard]] LineStatus status(Instant now) const override;

private:
    struct Late {
        Frame frame;
        Priority priority = Priority::command;
        Instant due{};
    };
    struct Direction {
        FaultRates rates;
        std::uint64_t random = 0;  // each direction has its own sequence, so that more traffic in one does not change the other
        bool to_drive = true;
        std::deque<Late> late;     // in order of `due`
        std::optional<Late> held;  // waits to be overtaken
        Instant since = never;     // instant of the first frame after the rates were set
    };

    void on_frame(const Frame& frame) override;
    void on_line_state(bool up, const std::string& why) override;
    void on_sent(const Frame& frame) override;

    bool spoil(Direction& direction, const Frame& frame, Priority priority, Instant now);
    bool spoil_bytes(Direction& direction, Frame frame, Priority priority, Instant now);
    bool give(Direction& direction, const Frame& frame, Priority priority, Instant now);
    bool pass(Direction& direction, const Frame& frame, Priority priority);
    bool queue(Direction& direction, const Frame& frame, Priority priority, Instant due, Instant now);
    void release(Direction& direction);
    void release_held(Direction& direction);
    void drop_late();
    void tell();

    std::unique_ptr<Line> inner_;
    LineEvents* events_ = nullptr;
    Direction out_, in_;
    FaultCounters counters_;
    Instant now_{};            // of the present call
    Instant tell_at_ = never;  // a change of state waits for on_deadline
    Instant heal_at_ = never;  // the end of bus-off
    bool inner_up_ = false;
    bool cut_ = false;
    bool published_up_ = false;
    std::string inner_why_ = "not opened yet";
    std::string cut_why_;
    std::uint64_t refused_ = 0;  // frames that send() refused because the line is cut or too many are late
};

}  // namespace axisgate
