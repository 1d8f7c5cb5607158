// Axis: what the adapter keeps of one axis of a control: its queue, the command in progress, its motion, its demand, what is known of it.
// In and out: nothing; plain state that the parts of a drive work with.
// Never unbounded: every list has its limit beside it, and the part that fills it says what happens there.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "adapters/pacontrol/parameters_elements.hpp"
#include "gateway/axis/demand.hpp"
#include "gateway/core/adapter.hpp"
#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/part.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/drive/turn.hpp"

namespace axisgate::pacontrol {

using drive::Turn;
class Drive;
using Part = drive::Part<Drive>;
struct Axis;

/// A verb of CiA 402, or of the control's own language, as exchanges (drive_verbs.hpp).
class Verb {
public:
    virtual ~Verb() = default;
    /// Goes on with the job of `a`: `reply` answers its request; nullptr: it begins, or what it waited for may have come.
    virtual void run(Axis& a, const Reply* reply, Turn& t) = 0;
};

/// A command on its way, taken apart into exchanges: at each step it either wants to send `request` or waits for something.
struct Job {
    enum class Kind : std::uint8_t { none, enable, reset, mode, home, origin, move, together, read, write, native, single };
    enum class Want : std::uint8_t { nothing, send, wait };
    Kind kind = Kind::none;
    Verb* verb = nullptr;
    Want want = Want::nothing;
    Command command;
    int step = 0;
    int rounds = 0;  ///< how often it began anew: bounded
    Request request;
    std::vector<std::uint8_t> raw;  ///< native, given in bytes: sent as they are
    bool poll = false;              ///< native: the lone EOT
    bool in_flight = false;         ///< its exchange is on the line
    bool processing = false;        ///< acknowledged, end of processing not yet reported
    bool begun = false;             ///< was being processed: what ends badly now has failed, it was not refused
    bool unknown = false;           ///< no answer to what cannot be repeated: reads the position back and ends as failed
    std::uint8_t tries = 0;         ///< of the present request
    Instant limit = never;          ///< of waiting
    Instant not_before{};           ///< the present request is sent then at the earliest
    Instant shown_at{};             ///< a reference run that is watched has shown itself for the last time
    std::int64_t place = 0;         ///< and where the axis was then, increments
    int flag = -1;                  ///< its reference flag; -1: not told
    std::string text;               ///< for the result
    Point point;
    std::vector<std::size_t> places;  ///< of several axes
    std::size_t at = 0;
    [[nodiscard]] bool active() const noexcept { return kind != Kind::none; }
    [[nodiscard]] bool waits() const noexcept { return active() && want == Want::wait; }
    [[nodiscard]] bool of_parameter() const noexcept { return kind == Kind::read || kind == Kind::write; }
};

/// A motion that was commanded and whose end is watched.
struct Motion {
    enum class Kind : std::uint8_t { none, position, velocity, manual, reference };
    Kind kind = Kind::none;
    std::int64_t target = 0;
    bool conditional = false;        ///< 0AA3 was set for it: an end short of the target is its right
    bool final_due = false;          ///< 1911 says it stands: status and position are read before its end is published
    std::uint64_t begun = 0;         ///< exchange count at its acknowledgement: answers to older questions do not end it
    Instant begun_at{}, stood_at{};  ///< acknowledged; 1911 has shown that it stands
    bool seen_running = false;       ///< the control has shown that it moves
    [[nodiscard]] bool active() const noexcept { return kind != Kind::none; }
};

/// What the demand of one axis rests on (demand.cpp): the control's own word where it has one (1915), else the orders that it acknowledged.
struct AxisDemand {
    enum Parameter : std::uint8_t { traverse_speed, start_stop_speed, acceleration, gear, enable_mode };
    static constexpr std::array<std::uint8_t, 5> numbers{0x01, 0x05, 0x06, 0x07, 0x32};  ///< of the axis parameters [L2214-L2220, L2268]
    struct Known {
        bool read = false;            ///< asked and answered, be it by a refusal
        std::optional<double> value;  ///< AE, AE/s, AE/s2; gear: AE per motor revolution
    };
    std::array<Known, numbers.size()> parameters;  ///< as they were in home position: nothing else can be asked there or changes them
    std::uint8_t next_parameter = 0;               ///< to be read anew

    Demand computed;             ///< increments
    DemandRamps ramps;           ///< of the motion under way, and of its stop
    double target = 0;           ///< increments
    std::int64_t shown = 0;      ///< the demand at the instant of the position published last; orders since then do not change it
    bool fresh = false;          ///< a position came since
    bool guided = false;         ///< on, ONLINE, in order: the axis is where orders have put it
    bool settle = true;          ///< once it stands the demand is where it stands
    bool stands = false;         ///< 1911 has shown so since `settle` was set
    bool speed_doubted = false;  ///< an override was sent and not acknowledged
    bool ramp_doubted = false;

    Instant shown_at{};         ///< when the oldest part of the position that is published now was received
    std::optional<double> lag;  ///< 1915, microsteps
    Instant lag_at{};
    bool lag_steady = true;         ///< the last two answers were alike: a position between two answers may go with the older one
    bool lag_new = false;           ///< answered since the last position
    bool lag_pairs = false;         ///< answered just before the position that is published now
    bool lag_missing = false;       ///< the control does not have it for this axis: asked no more
    bool lag_due = false;           ///< stands anew: asked once
    bool lag_turn = false;          ///< of the two that share a place in the cycle it is 1915's turn
    std::uint8_t lag_refusals = 0;  ///< in a row, as inadmissible

    /// 1915 can be had, and its microsteps mean something: the way of one revolution is known.
    [[nodiscard]] bool has_lag() const noexcept { return guided && !lag_missing && parameters[gear].value.value_or(0) > 0; }
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
    std::int64_t counter = 0;  ///< 190C as it was last received, increments
    bool position_known = false;
    bool missing = false;                ///< the control answers 20h: it has no such axis
    bool on = false;                     ///< 0A97 acknowledged since ONLINE began
    bool off_ordered = false;            ///< 0A98 acknowledged since it was enabled last
    bool no_switch = false;              ///< the control cannot switch it on or off (0A97, 0A98: 13h or 15h)
    Instant switching_until{};           ///< 0A97 was acknowledged: until then 37h may only mean that it is not on yet
    Instant stopping_until{};            ///< a stop was acknowledged: until then 2Ah may only mean that it still brakes
    int status = -1;                     ///< 1910: 0 in position, 1 moving, 2 stopped, 4 malfunction, 8 measuring; -1 not read yet
    bool malfunction_published = false;  ///< asking for status 4 anew does not make it news
    std::uint16_t trouble = 0;  ///< PA-CONTROL error of the fault that lasts: status 4 may be read for a while after the number has gone
    int limits = -1;            ///< 1921: bit 0 power pack ready, 1 positive switch free, 2 negative switch free; -1 not read
    bool power_lost = false;    ///< its power pack went while it was on, and is not ready since
    bool extended_missing = false;  ///< 1921 is not executable here: 1910 is read in its place
    bool reached = false;           ///< the last motion has ended at its target, by the control's counter
    bool running = false;
    bool looked_at = false;                                          ///< closely: asked in each cycle
    Instant counter_at{}, velocity_at{}, running_at{}, status_at{};  ///< when 190C, 190D, 1911 and 1910 or 1921 were received last
    Motion motion;
    std::optional<std::int64_t> speed, acceleration;  ///< overrides in force, increments/s and /s2
    AxisDemand demand;
    drive::PollTimer renewal;  ///< manual move: next 0A92
    bool condition_set = false;
    bool prepared = false;
    Request prepared_request;
    Motion prepared_motion;
    std::string lost;  ///< a motion whose end was never received: published with the position that is read back

    drive::CommandQueue queue{queue_limit};
    Job job;
    std::vector<Wait> waits;

    [[nodiscard]] bool used() const noexcept { return id != no_axis; }       ///< by the site
    [[nodiscard]] bool here() const noexcept { return used() && !missing; }  ///< and the control has it
    [[nodiscard]] bool moves() const noexcept { return running || motion.active(); }
    [[nodiscard]] std::size_t place() const noexcept { return static_cast<std::size_t>(channel) - 1; }
    [[nodiscard]] std::uint32_t number() const noexcept { return static_cast<std::uint32_t>(channel); }  ///< as the control counts axes
    [[nodiscard]] std::uint16_t status_code() const noexcept { return extended_missing ? code::status_axis : code::extended_status; }
};

}  // namespace axisgate::pacontrol
