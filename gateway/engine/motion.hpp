// Motion: the record of what moves an axis: whose it is, by which way in, how far it may go and what ends it.
// A guard that is noted with an order is lost with the next order, whatever becomes of that one. Guards stand here instead: an order
// makes a record when the drive has acknowledged it, and only standstill, seen at the drive, takes a record away.
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
        velocity,  ///< at `target`, until it is told otherwise
        homing,
        stream,     ///< set-points that its client renews
        statement,  ///< by a native statement, an action or a program that could not be read beforehand
        found       ///< nobody's: it was under way when the axis was seen first, or began at the drive
    };
    Kind kind = Kind::none;
    AuthorityClient who{};     ///< whose loss ends it; door none: nobody that is known
    AuthorityClient keeper{};  ///< who has taken the axis over from its owner meanwhile: the loss of either of them ends it
    Origin origin{};
    SetPoint::Mode stream = SetPoint::Mode::position;
    std::int64_t target = 0;        ///< increments; of velocity moves and streams increments/s, of torque streams 1/1000
    std::int64_t velocity = 0;      ///< increments/s, as the order named it; 0: it named none
    std::int64_t acceleration = 0;  ///< increments/s^2; 0: it named none
    std::int64_t deceleration = 0;  ///< increments/s^2; 0: it named none
    Duration hold{};                ///< dead-man time-out; 0: none
    Instant hold_until = never;
    Instant since{};    ///< when the drive acknowledged it, or it was seen first
    Instant rested{};   ///< since when it is seen at rest, without a break; the beginning of time: it moves, or nothing was seen yet
    bool over = false;  ///< a stop was acknowledged, or its power went: standstill is what is waited for
    LossCause ended_for = LossCause::none;  ///< the loss for which it was ended; one loss acts once on one motion
    bool alarmed = false;                   ///< the supervisor has stopped it, and said so

    [[nodiscard]] bool runs() const noexcept { return kind != Kind::none; }
    [[nodiscard]] bool is_of(const AuthorityClient& client) const noexcept {
        return who == client || (keeper.door != Door::none && keeper == client);
    }
    /// It has no end of its own. `course`: what the drive says of it, where the record cannot know.
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

/// The stops of an axis that are on their way to its drive, one of a kind at most, and the last one that matters until the axis rests.
class Stops {
public:
    enum class Kind : std::uint8_t { halt, quick_stop, disable };  ///< the stronger one is the greater one
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
        Ticket order = no_ticket;           ///< none: nothing of this kind is on its way
        std::vector<std::uint64_t> joined;  ///< clients that asked for the same meanwhile: they get the same answer
    };
    std::array<OnTheWay, kinds> on_the_way{};
    [[nodiscard]] OnTheWay& of(Kind kind) noexcept { return on_the_way[static_cast<std::size_t>(kind)]; }
    /// A quick stop has no answer yet: nothing may be begun behind it.
    [[nodiscard]] bool bars_motion() const noexcept { return on_the_way[static_cast<std::size_t>(Kind::quick_stop)].order != no_ticket; }

    /// A stop was asked for at this instant of orders, and of which kind: an order with a smaller number was given before it, and what it
    /// begins begins behind the stop.
    Ticket asked = no_ticket;
    Kind asked_kind = Kind::halt;

    std::optional<Kind> wanted;   ///< until the axis is seen at rest, or a motion was acknowledged since
    bool acknowledged = false;    ///< ... by the drive
    Instant given_at{};           ///< when it was sent last
    std::int64_t speed_then = 0;  ///< of the axis, when it was sent first; increments/s
    Instant first_at{};           ///< when it was sent first
};

/// After a stop of somebody else nobody moves the axis but by a fresh edge of his own words: what registers show of that.
struct StopLatch {
    static constexpr std::uint16_t latched = 1u << 0, by_fail_safe = 1u << 1, by_client = 1u << 2, by_safe_input = 1u << 3;
    std::uint16_t bits = 0;             ///< register 23
    AuthorityClient by{};               ///< the client whose stop it is; door none: the gateway's own
    LossCause cause = LossCause::none;  ///< register 22: why the axis was stopped without a command, until the next one
};

/// The way that the axis goes, as its feedback tells it: how long it takes until the next position.
struct Watch {
    std::int64_t position = 0;
    Instant since{};     ///< when `position` became that
    double round_s = 0;  ///< between the last two positions: how late the next one may be, and a stop on the same line
};

}  // namespace axisgate::engine
