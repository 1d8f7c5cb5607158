// The ways by which a client can set an axis in motion, with the causes of loss that end such a motion, as each door registers them before
// threads start. No code below the doors names one of them. Every family is rehearsed for each way (tests/conformance).
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/site/fail_safe.hpp"

namespace axisgate {

struct WayIn {
    std::string_view name;
    Door door = Door::none;  ///< of the client, as in leases and events
    bool streams = false;    ///< by set-points that are renewed instead of commands
    std::span<const LossCause>
        losses;                 ///< that end the motion; the door reports them, or the engine for the end of a lease or of the gateway
    bool by_registers = false;  ///< the client writes registers cyclically, as controllers do; otherwise it sends commands by name
};

/// The facts about a door that the engine, the site and the services use. Two protocol servers with the same kind of client (Modbus/TCP and
/// Modbus RTU) share one.
struct DoorWords {
    Door door = Door::none;             ///< number in register 17
    std::string_view name;              ///< name in leases, events and the database
    std::span<const WayIn> ways;        ///< all ways of this door
    std::span<const LossWords> losses;  ///< the causes that the door itself defines
    /// The cause if a commanding client sends nothing for the axis' watchdog time; none: the door monitors that itself.
    LossCause silence = LossCause::none;
    /// The cause if streamed set-points are not renewed in time.
    LossCause unrenewed = LossCause::set_points_silent;
    /// True if its clients are users and tokens of this gateway, who lose their rights with their roles.
    bool of_users = false;
};

/// Losses for clients of every door, which the engine detects itself.
inline constexpr std::array losses_of_anybody{LossCause::line_lost, LossCause::gateway_ends, LossCause::motion_unowned};

[[nodiscard]] constexpr bool tells(const WayIn& way, LossCause cause) {
    return std::find(way.losses.begin(), way.losses.end(), cause) != way.losses.end();
}

namespace law {
constexpr bool each_way_has_a_loss(const DoorWords& words) {
    for (const WayIn& way : words.ways) {
        if (way.losses.empty() || way.door != words.door || way.name.empty()) return false;
    }
    return true;
}
/// Every cause of the door ends at least one of its ways.
constexpr bool each_loss_has_a_teller(const DoorWords& words) {
    for (const LossWords& loss : words.losses) {
        bool told = false;
        for (const WayIn& way : words.ways)
            told = told || tells(way, loss.cause);
        if (!told) return false;
    }
    return true;
}
}  // namespace law

/// Registers a door with its causes of loss and its ways; `words` must live as long as the process. Registering it again is not a fault.
/// Returns an empty string, or the fault or conflict with another door.
[[nodiscard]] std::string bring(const DoorWords& words);
/// nullptr if the door is not registered.
[[nodiscard]] const DoorWords* words_of(Door door) noexcept;
/// All registered doors, in the order of their numbers.
[[nodiscard]] std::vector<const DoorWords*> known_doors();

/// The first door with a way that this cause ends; none if there is no such way.
[[nodiscard]] Door door_that_tells(LossCause cause);
/// True if the cause ends only ways that stream set-points.
[[nodiscard]] bool of_streams_alone(LossCause cause);
/// True if the cause means that the client sent nothing for the watchdog time.
[[nodiscard]] bool is_silence(LossCause cause);
/// The cause for a client of this door whose streamed set-points have stopped.
[[nodiscard]] LossCause unrenewed_of(Door door) noexcept;
/// True if the clients of this door are users and tokens of this gateway.
[[nodiscard]] bool has_users(Door door) noexcept;

}  // namespace axisgate
