// Fail-safe: the action for an axis whose commanding client is lost: the causes, the actions, and the choice for one axis.
// The doors detect the loss; this file only reads the names of the site's document and returns the action for a cause.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/instant.hpp"

namespace axisgate {

/// The reason why the commanding client of an axis counts as lost. The numbers are those of register 22 of the standard map. The causes
/// here are those that the gateway itself detects for clients of every door; each door brings its own (DoorWords in
/// gateway/site/ways_in.hpp).
enum class LossCause : std::uint8_t {
    none = 0,
    set_points_silent = 3,  ///< it streamed set-points, and the next one did not arrive in time or their connection has ended
    lease_ended = 4,        ///< it held the axis by a lease, and let it expire
    line_lost = 8,          ///< the drive could not be reached while it was commanded; the action follows when it answers again
    gateway_ends = 9,       ///< the gateway itself is shutting down
    motion_unowned = 13     ///< the axis moves without an order from a client of this gateway
};
inline constexpr std::size_t most_loss_causes = 64;  ///< their numbers are 1 to 63

/// The texts of a cause.
struct LossWords {
    LossCause cause = LossCause::none;
    std::string_view name;         ///< in the site's document, events and metrics
    std::string_view description;  ///< the condition, for the table of choices
    std::string_view text;         ///< of an event, after "CLIENT commanded the axis and"
    std::string_view text_after;   ///< the same with {} for the time that has passed, in ms; empty: as `text`
};

/// The registered causes, in the order of their numbers.
class LossCauses {
public:
    void add(LossCause cause) noexcept { list_[size_++] = cause; }
    [[nodiscard]] const LossCause* begin() const noexcept { return list_.data(); }
    [[nodiscard]] const LossCause* end() const noexcept { return list_.data() + size_; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }

private:
    std::array<LossCause, most_loss_causes> list_{};
    std::size_t size_ = 0;
};
[[nodiscard]] LossCauses loss_causes() noexcept;
/// nullptr if the cause is not registered.
[[nodiscard]] const LossWords* words_of(LossCause cause) noexcept;
/// "none" for none, "unknown" for a cause that is not registered.
[[nodiscard]] std::string_view name_of(LossCause cause) noexcept;
/// Registers a cause of a door; the texts must live as long as the process. Registering the same cause again is not a fault.
/// Returns an empty string, or the conflict with another cause.
[[nodiscard]] std::string name_loss(const LossWords& words);

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
    std::array<std::optional<FailSafeAction>, most_loss_causes> chosen;
    std::optional<std::int64_t> watchdog_ms;  ///< 0: silence is not monitored; absent: [modbus] watchdog_ms of the gateway, for every door

    [[nodiscard]] std::optional<FailSafeAction>& of(LossCause cause) { return chosen.at(static_cast<std::size_t>(cause)); }
    [[nodiscard]] const std::optional<FailSafeAction>& of(LossCause cause) const { return chosen.at(static_cast<std::size_t>(cause)); }
    /// The action for an axis in this state.
    [[nodiscard]] FailSafeAction action(LossCause cause, const AtLoss& axis) const;
    [[nodiscard]] Duration watchdog(Duration by_default) const noexcept;
    bool operator==(const FailSafe&) const = default;
};

}  // namespace axisgate
