// The record of the motion of an axis: its owner, the way by which it was commanded, its limits and its end. A guard that is stored with an
// order is lost with the next order, even if that one fails. Therefore guards are stored here: an order makes a record when the drive has
// acknowledged it, and only an observed standstill removes it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/axis/authority.hpp"
#include "gateway/core/command.hpp"
#include "gateway/core/sample.hpp"
#include "gateway/site/fail_safe.hpp"

namespace axisgate::engine {

/// How the order of an acknowledged motion stands to the last stop of its axis.
enum class MotionOrder : std::uint8_t { in_turn, behind_a_stop };

struct Motion {
    enum class Kind : std::uint8_t {
        none,
        position,  ///< to `target`
        velocity,  ///< at `target`, until another order
        homing,
        stream,     ///< set-points that its client renews
        statement,  ///< by a native statement, an action or a program that could not be read
        found       ///< of no client: it was in progress when the axis was first seen, or began at the drive
    };
    Kind kind = Kind::none;
    AuthorityClient who{};     ///< the owner, whose loss ends it; door none: unknown
    AuthorityClient keeper{};  ///< the client that has taken the axis over since; the loss of either of them ends the motion
    Origin origin{};
    SetPoint::Mode stream = SetPoint::Mode::position;
    std::int64_t target = 0;        ///< increments; of velocity moves and streams increments/s, of torque streams 1/1000
    std::int64_t velocity = 0;      ///< increments/s, as the order named it; 0: it named none
    std::int64_t acceleration = 0;  ///< increments/s^2; 0: it named none
    std::int64_t deceleration = 0;  ///< increments/s^2; 0: it named none
    Duration hold{};                ///< dead-man time; 0: none
    Instant hold_until = never;
    Instant since{};    ///< when the drive acknowledged it, or it was first seen
    Instant rested{};   ///< since when the axis is at rest without interruption; the beginning of time: it moves, or no feedback has
                        ///< arrived yet
    bool over = false;  ///< a stop was acknowledged, or the power was switched off; only the standstill is awaited
    LossCause ended_for = LossCause::none;  ///< the loss for which it was ended; one loss acts once on a motion
    bool alarmed = false;                   ///< the supervisor has stopped it and raised the alarm

    [[nodiscard]] bool runs() const noexcept { return kind != Kind::none; }
    [[nodiscard]] bool is_of(const AuthorityClient& client) const noexcept {
        return who == client || (keeper.door != Door::none && keeper == client);
    }
    /// True if the motion has no end of its own. `course` is the drive's report, for motions whose course the record does not contain.
    [[nodiscard]] bool endless(Course course) const noexcept {
        switch (kind) {
            case Kind::velocity:
                return target != 0;
            case Kind::stream:
                return true;
            case Kind::statement:
            case Kind::found:
                return course != Course::to_target;
            case Kind::none:
            case Kind::position:
            case Kind::homing:
                break;
        }
        return false;
    }
};

/// The stops of an axis that are on their way to its drive, at most one of each kind, and the last stop that counts until the axis rests.
class Stops {
public:
    enum class Kind : std::uint8_t { halt, quick_stop, disable };  ///< ordered by strength
    static constexpr std::size_t kinds = 3;
    [[nodiscard]] static std::optional<Kind> of(const CommandBody& body) noexcept {
        if (std::holds_alternative<Halt>(body)) return Kind::halt;
        if (std::holds_alternative<QuickStop>(body)) return Kind::quick_stop;
        if (std::holds_alternative<Disable>(body)) return Kind::disable;
        return std::nullopt;
    }
    [[nodiscard]] static CommandBody body(Kind kind) {
        if (kind == Kind::halt) return Halt{};
        if (kind == Kind::quick_stop) return QuickStop{};
        return Disable{};
    }

    struct OnTheWay {
        Ticket order = no_ticket;           ///< none: no stop of this kind is on its way
        std::vector<std::uint64_t> joined;  ///< clients that requested the same stop meanwhile; they get the same answer
    };
    std::array<OnTheWay, kinds> on_the_way{};
    [[nodiscard]] OnTheWay& of(Kind kind) noexcept { return on_the_way[static_cast<std::size_t>(kind)]; }
    /// A quick stop has no answer yet, so nothing may begin behind it.
    [[nodiscard]] bool bars_motion() const noexcept { return on_the_way[static_cast<std::size_t>(Kind::quick_stop)].order != no_ticket; }

    /// The order number at which a stop was requested, and its kind. An order with a smaller number was given before the stop; a motion
    /// that it starts begins behind the stop.
    Ticket asked = no_ticket;
    Kind asked_kind = Kind::halt;

    std::optional<Kind> wanted;   ///< until the axis is at rest, or another motion was acknowledged
    bool acknowledged = false;    ///< true if the drive has acknowledged it
    Instant given_at{};           ///< when it was last sent
    std::int64_t speed_then = 0;  ///< speed of the axis when it was first sent, increments/s
    Instant first_at{};           ///< when it was first sent
};

/// The latch of a stop by another client: only a fresh edge of a client's own control word moves the axis again. Registers show it.
struct StopLatch {
    static constexpr std::uint16_t latched = 1u << 0, by_fail_safe = 1u << 1, by_client = 1u << 2, by_safe_input = 1u << 3;
    std::uint16_t bits = 0;             ///< register 23
    AuthorityClient by{};               ///< the client that has stopped the axis; door none: the gateway
    LossCause cause = LossCause::none;  ///< register 22: the cause for which the axis was stopped without a command, until the next command
};

/// The progress of the position between two reports, from which the age of the next report is estimated.
struct Watch {
    std::int64_t position = 0;
    Instant since{};     ///< when `position` was first reported
    double round_s = 0;  ///< time between the last two positions, which is also the delay of a stop on the same line
};

}  // namespace axisgate::engine
