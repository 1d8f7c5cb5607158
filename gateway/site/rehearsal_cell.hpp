// The request for the rehearsal of one loss of command, and its result: the action that was taken, and the times. These are values only;
// the engine plays the rehearsal.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/instant.hpp"
#include "gateway/site/fail_safe.hpp"

namespace axisgate {

/// Optional events of a rehearsal in addition to the loss.
enum class RehearsalStep : std::uint8_t {
    second_client,     ///< before the loss, another client reads, resets, is refused, and disconnects
    refused_commands,  ///< before the loss, commands of the client that moves the axis are refused
    gateway_restart,   ///< a separate situation: the gateway is killed, and another one is started while the axis moves
    old_image          ///< after the standstill the client connects again and continues to write its previous registers
};
inline constexpr std::array<RehearsalStep, 4> rehearsal_steps{RehearsalStep::second_client, RehearsalStep::refused_commands,
                                                              RehearsalStep::gateway_restart, RehearsalStep::old_image};
/// The name of the enumerator, as in the API.
[[nodiscard]] std::string_view name_of(RehearsalStep step) noexcept;
[[nodiscard]] std::optional<RehearsalStep> rehearsal_step_of(std::string_view name) noexcept;

class RehearsalSteps {
public:
    constexpr void add(RehearsalStep step) noexcept { bits_ |= bit(step); }
    [[nodiscard]] constexpr bool has(RehearsalStep step) const noexcept { return (bits_ & bit(step)) != 0; }
    [[nodiscard]] static constexpr RehearsalSteps all() noexcept {
        RehearsalSteps s;
        for (const RehearsalStep step : rehearsal_steps)
            s.add(step);
        return s;
    }

private:
    [[nodiscard]] static constexpr unsigned bit(RehearsalStep step) noexcept { return 1u << static_cast<unsigned>(step); }
    unsigned bits_ = 0;
};

struct RehearsalWish {
    std::string axis;  ///< of the site
    /// none: the gateway stops without a report (power supply, kill), and the drive reacts alone.
    LossCause cause = LossCause::none;
    bool restart = false;  ///< with none: another gateway is started while the axis may still move
    RehearsalSteps steps{};
    Duration watchdog = std::chrono::seconds(5);      ///< [modbus] watchdog_ms
    Duration lease = std::chrono::seconds(30);        ///< how long a command reserves an axis
    Duration line_away = std::chrono::seconds(2);     ///< line_lost: how long the drive is silent
    Duration gateway_away = std::chrono::seconds(3);  ///< restart: how long no gateway runs
};

/// One cell of the matrix. Times in ms from the loss. The loss is the last request, set-point or command if silence is the cause; the
/// drive's silence for line_lost; the gateway's end if it is killed; otherwise the door's report.
struct RehearsalCell {
    std::string axis;
    LossCause cause = LossCause::none;               ///< none: the gateway is gone, and the drive reacts alone
    bool restart = false;                            ///< ... until another gateway has started
    std::optional<FailSafeAction> chosen;            ///< the site's choice; empty: the default
    FailSafeAction taken = FailSafeAction::nothing;  ///< the action that the engine took
    std::string motion;                              ///< "velocity", "position", "set_points"
    double speed = 0;                                ///< at the loss, in the axis' unit/s, measured at the mechanics
    std::optional<double> noticed_ms;                ///< the engine acted; empty: it did not
    std::optional<double> reaction_ms;               ///< the speed was reduced by one tenth for the first time
    std::optional<double> standstill_ms;             ///< standstill; empty: the axis was still moving at the end of the observation
    double watched_ms = 0;                           ///< duration of the observation
    double travel = 0;                               ///< from the loss until standstill or the end of the observation, in the axis' unit
    /// The cause of the end of the motion: the name of the loss for which the engine acted; "supervisor", "target" (reached), "drive" (by
    /// itself), or the name of the step that ended it before the loss. Empty: it has not ended.
    std::string ended_by;
    std::optional<bool> moved_again;  ///< the client connected again with its previous image, and the axis moved; empty: it did not
                                      ///< connect, or has no image
    std::string fault;                ///< why there are no values
};

/// "modbus_closed"; "gateway_gone", "gateway_restarts".
[[nodiscard]] std::string_view situation_of(const RehearsalCell& cell) noexcept;

}  // namespace axisgate
