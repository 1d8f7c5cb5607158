// Fail-safe: what is done with an axis when whoever commands it is lost: causes, actions, and one axis' choice among them.
// In: names from the site's document. Out: values, and what the axis does for a cause. Never decides that somebody is lost: doors tell
// that.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "gateway/core/instant.hpp"

namespace axisgate {

/// Why the commander of an axis counts as lost. The numbers are register 22 of the standard map.
enum class LossCause : std::uint8_t {
    none = 0,
    modbus_closed = 1,         ///< its last Modbus connection has ended: by itself, by the network, or closed by the gateway
    modbus_silent = 2,         ///< connected, but no request for longer than the watchdog time
    set_points_silent = 3,     ///< it streamed set-points (not over DDS), and the next one did not come in time
    lease_ended = 4,           ///< it held the axis by a lease, and let it expire
    enip_closed = 5,           ///< its EtherNet/IP connection was closed, by its scanner or by the gateway
    enip_timed_out = 6,        ///< its EtherNet/IP connection brought nothing for its time-out (interval x multiplier)
    enip_idle = 7,             ///< its scanner says that it is in program mode (the run/idle bit)
    line_lost = 8,             ///< the drive could not be reached while it was commanded; acted upon when it answers again
    gateway_ends = 9,          ///< the gateway itself is told to end
    dds_deadline = 10,         ///< it commands over DDS: its set-point missed its deadline, or nobody writes for it any more (liveliness)
    enip_session_closed = 11,  ///< it commanded by EtherNet/IP messages, and its last session has ended
    enip_silent = 12,          ///< its EtherNet/IP session is open, but no message came for longer than the watchdog time
    motion_unowned = 13        ///< the axis moves and no client of this gateway has ordered it
};
inline constexpr std::array<LossCause, 13> loss_causes{
    LossCause::modbus_closed, LossCause::modbus_silent,  LossCause::set_points_silent,   LossCause::lease_ended,
    LossCause::enip_closed,   LossCause::enip_timed_out, LossCause::enip_idle,           LossCause::line_lost,
    LossCause::gateway_ends,  LossCause::dds_deadline,   LossCause::enip_session_closed, LossCause::enip_silent,
    LossCause::motion_unowned};
/// As the enumerator is called: the word of the site's document.
[[nodiscard]] std::string_view name_of(LossCause cause) noexcept;

enum class FailSafeAction : std::uint8_t { nothing, halt, quick_stop, disable };
inline constexpr std::array<FailSafeAction, 4> fail_safe_actions{FailSafeAction::nothing, FailSafeAction::halt, FailSafeAction::quick_stop,
                                                                 FailSafeAction::disable};
[[nodiscard]] std::string_view name_of(FailSafeAction action) noexcept;
[[nodiscard]] std::optional<FailSafeAction> fail_safe_action_of(std::string_view name) noexcept;

/// What an axis does at the moment of the loss.
struct AtLoss {
    bool endless = false;  ///< it runs at a speed, or follows set-points
    bool moving = false;
    bool powered = false;  ///< it is enabled or about to be
};

/// One axis' choice. What the site does not name has the default: a motion without an end of its own (a velocity move) is halted; a motion
/// to a target goes on to its target, since a client may connect for each of its requests; when the gateway itself ends, every motion is
/// stopped quickly, and so is a motion that nobody owns unless its drive says that it ends at a target. What the site names holds for every
/// motion, and `disable` for an enabled axis at rest as well.
struct FailSafe {
    std::array<std::optional<FailSafeAction>, loss_causes.size()> chosen;
    std::optional<std::int64_t> watchdog_ms;  ///< 0: silence is not watched; absent: the gateway's [modbus] watchdog_ms, for every door

    [[nodiscard]] std::optional<FailSafeAction>& of(LossCause cause) { return chosen.at(static_cast<std::size_t>(cause) - 1); }
    [[nodiscard]] const std::optional<FailSafeAction>& of(LossCause cause) const { return chosen.at(static_cast<std::size_t>(cause) - 1); }
    /// What becomes of an axis that does this.
    [[nodiscard]] FailSafeAction action(LossCause cause, const AtLoss& axis) const;
    [[nodiscard]] Duration watchdog(Duration by_default) const noexcept;
    bool operator==(const FailSafe&) const = default;
};

}  // namespace axisgate
