// FaultLine: a line that goes wrong on purpose: loses, doubles, garbles, shortens, delays, swaps and invents frames, and can be cut.
// In: a line to wrap, a seed, what shall go wrong how often. Out: the same events as a line, spoiled; how often what was done.
// Never takes randomness from elsewhere: the same seed and the same calls spoil the same frames in the same way.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "gateway/core/line.hpp"

namespace axisgate {

/// What goes wrong in one direction. Probabilities are per frame, 0..1, and independent of each other.
struct FaultRates {
    double loss = 0;
    double duplicate = 0;  ///< it comes twice
    double flip = 0;       ///< one bit of its content is turned over
    double truncate = 0;   ///< it ends early
    double insert = 0;     ///< bytes: 1..8 foreign bytes somewhere in it; CAN: a foreign frame before it
    double delay = 0;      ///< it is late, and everything behind it waits: a wire does not overtake
    Duration delay_max{};  ///< by more than zero and at most this
    /// CAN alone: it is overtaken by the next one of its direction, as between two mailboxes of a controller; if none comes within
    /// FaultLine::overtaken_at_most, it goes by itself. Bytes keep their order on every wire.
    double reorder = 0;
    Duration drift{};      ///< a line that gets slower: all are later by this for every second since the rates were set ...
    Duration drift_max{};  ///< ... but by no more than this
};

struct FaultPlan {
    std::uint64_t seed = 1;
    FaultRates to_drive;
    FaultRates from_drive;
};

struct FaultCounters {
    std::uint64_t lost = 0, duplicated = 0, flipped = 0, truncated = 0, inserted = 0, delayed = 0, reordered = 0;
    std::uint64_t swallowed = 0;   ///< while the line was cut
    std::uint64_t overflowed = 0;  ///< more than FaultLine::max_delayed frames were late in one direction
};

class FaultLine final : public Line, private LineEvents {
public:
    static constexpr std::size_t max_delayed = 1024;
    static constexpr Duration overtaken_at_most = std::chrono::milliseconds(2);

    FaultLine(std::unique_ptr<Line> inner, const FaultPlan& plan);

    /// New rates from the next frame on; the random sequence goes on.
    void set_rates(const FaultRates& to_drive, const FaultRates& from_drive) noexcept;
    /// Pulls the cable: the owner hears it at the next on_deadline. Frames of both directions vanish, also those that are late; what the
    /// inner line has taken already still leaves, unheard.
    void cut(Instant now, std::string why = "cut on purpose");
    /// CAN: the controller has seen too many errors and leaves the bus: it reports so, the line is down, and comes back by itself.
    void bus_off(Instant now, Duration pause);
    /// Plugs it in again; up as soon as the inner line is.
    void heal(Instant now);
    [[nodiscard]] bool is_cut() const noexcept { return cut_; }

    [[nodiscard]] const FaultCounters& counters() const noexcept { return counters_; }
    [[nodiscard]] Line& inner() noexcept { return *inner_; }

    void open(LineEvents& events, Instant now) override;
    void close() override;
    bool send(const Frame& frame, Priority priority, Instant now) override;
    [[nodiscard]] Instant deadline() const override;
    void on_deadline(Instant now) override;
    /// The inner line's, with this line's own state and losses.
    [[nodiscard]] LineStatus status(Instant now) const override;

private:
    struct Late {
        Frame frame;
        Priority priority = Priority::command;
        Instant due{};
    };
    struct Direction {
        FaultRates rates;
        std::uint64_t random = 0;  // each direction has its own sequence: more traffic in one leaves the other as it was
        bool to_drive = true;
        std::deque<Late> late;     // in order of `due`
        std::optional<Late> held;  // waits to be overtaken
        Instant since = never;     // of the rates: the first frame after they were set
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
    std::uint64_t refused_ = 0;  // frames that send() did not take because the line is cut or too many are late
};

}  // namespace axisgate
