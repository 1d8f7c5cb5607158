// Fail-safe: the action for an axis whose commanding client is lost: the causes, the actions, and the choice for one axis.
// The doors detect the loss; this file only reads the names of the site's document and returns the action for a cause.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "gateway/core/instant.hpp"

namespace axisgate {

/// The reason why the commanding client of an axis counts as lost. The numbers are those of register 22 of the standard map.
enum class LossCause : std::uint8_t {
    none = 0,
    modbus_closed = 1,         ///< its last Modbus connection has ended: by itself, by the network, or closed by the gateway
    modbus_silent = 2,         ///< connected, but no request for longer than the watchdog time
    set_points_silent = 3,     ///< it streamed set-points (not over DDS), and the next one did not arrive in time
    lease_ended = 4,           ///< it held the axis by a lease, and let it expire
    enip_closed = 5,           ///< its EtherNet/IP connection was closed, by its scanner or by the gateway
    enip_timed_out = 6,        ///< its EtherNet/IP connection received nothing for its time-out (interval x multiplier)
    enip_idle = 7,             ///< its scanner has signalled program mode (the run/idle bit)
    line_lost = 8,             ///< the drive could not be reached while it was commanded; the action follows when it answers again
    gateway_ends = 9,          ///< the gateway itself is shutting down
    dds_deadline = 10,         ///< it commands over DDS: its set-point missed its deadline, or it no longer has a writer (liveliness)
    enip_session_closed = 11,  ///< it commanded by EtherNet/IP messages, and its last session has ended
    enip_silent = 12,          ///< its EtherNet/IP session is open, but no message came for longer than the watchdog time
    motion_unowned = 13        ///< the axis moves without an order from a client of this gateway
};
inline constexpr std::array<LossCause, 13> loss_causes{
    LossCause::modbus_closed, LossCause::modbus_silent,  LossCause::set_points_silent,   LossCause::lease_ended,
    LossCause::enip_closed,   LossCause::enip_timed_out, LossCause::enip_idle,           LossCause::line_lost,
    LossCause::gateway_ends,  LossCause::dds_deadline,   LossCause::enip_session_closed, LossCause::enip_silent,
    LossCause::motion_unowned};
/// The name of the enumerator, as in the site's document.
[[nodiscard]] std::string_view name_of(LossCause cause) noexcept;

enum class FailSafeAction : std::uint8_t { nothing, halt, quick_stop, disable };
inline constexpr std::array<FailSafeAction, 4> fail_safe_actions{FailSafeAction::nothing, FailSafeAction::halt, FailSafeAction::quick_stop,
                                                                 FailSafeAction::disable};
[[nodiscard]] std::string_view name_of(FailSafeAction action) noexcept;
[[nodiscard]] std::optional<FailSafeAction> fail_safe_action_of(std::string_view name) noexcept;

/// The state of an axis at the moment of the loss.
struct AtLoss {
    bool endless = false;  ///< it runs at a speed, or follows set-points
    bool moving = false;
    bool powered = false;  ///< it is enabled or being enabled
};

/// The choice for one axis. Causes that the site does not name have the default: a motion without an end of its own (a velocity move) is
/// halted; a motion to a target is completed, since a client may connect for each of its requests; when the gateway shuts down, every
/// motion is stopped quickly, and so is a motion without an owner unless its drive reports that it ends at a target. A choice of the site
/// applies to every motion, and `disable` also to an enabled axis at rest.
struct FailSafe {
    std::array<std::optional<FailSafeAction>, loss_causes.size()> chosen;
    std::optional<std::int64_t> watchdog_ms;  ///< 0: silence is not monitored; absent: [modbus] watchdog_ms of the gateway, for every door

    [[nodiscard]] std::optional<FailSafeAction>& of(LossCause cause) { return chosen.at(static_cast<std::size_t>(cause) - 1); }
    [[nodiscard]] const std::optional<FailSafeAction>& of(LossCause cause) const { return chosen.at(static_cast<std::size_t>(cause) - 1); }
    /// The action for an axis in this state.
    [[nodiscard]] FailSafeAction action(LossCause cause, const AtLoss& axis) const;
    [[nodiscard]] Duration watchdog(Duration by_default) const noexcept;
    bool operator==(const FailSafe&) const = default;
};

}  // namespace axisgate
