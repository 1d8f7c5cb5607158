// Axis: what the adapter keeps of one axis of a control: its queue, the command in progress, its motion, what is known of it.
// In and out: nothing; plain state that Control works with.
// Never unbounded: every list has its limit beside it, and Control says what happens at it.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "adapters/pacontrol/elements.hpp"
#include "gateway/core/adapter.hpp"

namespace axisgate::pacontrol {

/// One call of the adapter from outside.
struct Turn {
    Instant now;
    Out& out;
};

/// A command on its way, taken apart into exchanges: at each step it either wants to send `request` or waits for something.
struct Job {
    enum class Kind : std::uint8_t { none, enable, reset, home, origin, move, together, read, write, native, single, mode };
    enum class Want : std::uint8_t { nothing, send, wait };
    Kind kind = Kind::none;
    Want want = Want::nothing;
    Command command;
    int step = 0;
    int rounds = 0;  ///< how often it began anew: bounded
    Request request;
    std::vector<std::uint8_t> raw;  ///< native, given in bytes: sent as they are
    bool poll = false;              ///< native: the lone EOT
    bool in_flight = false;         ///< its exchange is on the line
    bool processing = false;        ///< acknowledged, end of processing not yet reported
    bool unknown = false;           ///< no answer to what cannot be repeated: reads the position back and ends as failed
    std::uint8_t tries = 0;         ///< of the present request
    Instant limit = never;          ///< of waiting
    std::string text;               ///< said in the result
    Point point;
    std::vector<std::size_t> places;  ///< together: the axes, by their place
    std::size_t at = 0;
    [[nodiscard]] bool active() const noexcept { return kind != Kind::none; }
};

/// A motion that was commanded and whose end is watched.
struct Motion {
    enum class Kind : std::uint8_t { none, position, velocity, manual, reference };
    Kind kind = Kind::none;
    std::int64_t target = 0;
    bool conditional = false;  ///< 0AA3 was set for it: an end short of the target is its right
    bool final_due = false;    ///< 1911 says it stands: status and position are read before anybody hears of it
    std::uint64_t begun = 0;   ///< exchange count at its acknowledgement: answers to older questions do not end it
    [[nodiscard]] bool active() const noexcept { return kind != Kind::none; }
};

struct Wait {
    enum class For : std::uint8_t { target, standstill, speed };
    For what = For::target;
    Ticket ticket = no_ticket;
    std::int64_t value = 0;
};

struct Axis {
    static constexpr std::size_t queue_limit = 64;  ///< one more is refused as busy
    static constexpr std::size_t wait_limit = 16;   ///< one more is answered `accepted`, and watched by its door

    AxisId id = no_axis;
    int channel = 1;
    AxisFeedback fb;
    bool position_known = false;
    bool missing = false;  ///< the control says 20h: it has no such axis
    bool on = false;       ///< 0A97 acknowledged since ONLINE began
    bool quick_stopped = false;
    bool referenced_own = false;    ///< as far as the gateway's own commands tell
    int status = -1;                ///< 1910: 0 in position, 1 moving, 2 stopped, 4 malfunction, 8 measuring; -1 not read yet
    int limits = -1;                ///< 1921: bit 0 power pack ready, 1 positive switch free, 2 negative switch free; -1 not read
    bool extended_missing = false;  ///< 1921 is not executable here: 1910 is read in its place
    bool running = false;
    Motion motion;
    std::optional<std::int64_t> speed, acceleration;  ///< overrides in force, increments/s and /s2
    Instant renew_at = never;                         ///< manual move: next 0A92
    bool condition_set = false;
    bool prepared = false;
    Request prepared_request;
    Motion prepared_motion;
    std::string lost;  ///< a motion whose end was never heard: told with the position that is read back

    std::deque<Command> queue;
    Job job;
    std::vector<Wait> waits;
};

}  // namespace axisgate::pacontrol
