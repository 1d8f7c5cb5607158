// Rehearsal cell: what is asked of the rehearsal of one loss of command, and what came of it.
// In: an axis, a cause, what else shall happen, the gateway's times. Out: what was done and how long it took. Values alone: who plays it is
// in the engine.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/instant.hpp"
#include "gateway/site/fail_safe.hpp"

namespace axisgate {

/// What happens in a rehearsal beside the loss, each by choice.
enum class RehearsalStep : std::uint8_t {
    second_client,     ///< before the loss another client reads, resets, is refused, and goes again
    refused_commands,  ///< before the loss commands of the client that moves the axis are refused
    gateway_restart,   ///< a situation of its own: the gateway is killed, and another one is started while the axis moves
    old_image          ///< after the standstill the client is back, and goes on writing the registers that it wrote before
};
inline constexpr std::array<RehearsalStep, 4> rehearsal_steps{RehearsalStep::second_client, RehearsalStep::refused_commands,
                                                              RehearsalStep::gateway_restart, RehearsalStep::old_image};
/// As the enumerator is called: the word of the API.
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
    /// none: the gateway itself is gone without a word (its supply, a kill): what its drive does then.
    LossCause cause = LossCause::none;
    bool restart = false;  ///< with none: another gateway is started while the axis may still move
    RehearsalSteps steps{};
    Duration watchdog = std::chrono::seconds(5);      ///< [modbus] watchdog_ms
    Duration lease = std::chrono::seconds(30);        ///< how long a command holds an axis
    Duration line_away = std::chrono::seconds(2);     ///< line_lost: for how long the drive is silent
    Duration gateway_away = std::chrono::seconds(3);  ///< restart: for how long there is no gateway
};

/// One cell of the matrix. Times in ms from the loss: from the last request, set-point or command where silence is the loss, from the
/// drive's silence for line_lost, from the gateway's end where it is killed, else from the moment at which the door tells it.
struct RehearsalCell {
    std::string axis;
    LossCause cause = LossCause::none;               ///< none: the gateway is gone, and the drive alone acts
    bool restart = false;                            ///< ... until another gateway has started
    std::optional<FailSafeAction> chosen;            ///< as the site has it; nothing: the default
    FailSafeAction taken = FailSafeAction::nothing;  ///< what the engine did
    std::string motion;                              ///< "velocity", "position", "set_points"
    double speed = 0;                                ///< at the loss, in the axis' unit/s, by the mechanics
    std::optional<double> noticed_ms;                ///< the engine acted; nothing: it did not
    std::optional<double> reaction_ms;               ///< the motor was slower than before by a tenth for the first time
    std::optional<double> standstill_ms;             ///< it stood; nothing: it went on for as long as it was watched
    double watched_ms = 0;                           ///< for how long it was watched
    double travel = 0;                               ///< from the loss until it stood or was watched no more, in the axis' unit
    /// What really ended the motion: the name of the cause for which the engine acted; "supervisor", "target" (it has arrived), "drive" (by
    /// itself), or the name of the step that disturbed it before the loss. Empty: it went on.
    std::string ended_by;
    std::optional<bool>
        moved_again;    ///< the client came back with its old image, and the axis moved; nothing: it did not come, or has none
    std::string fault;  ///< why there are no figures
};

/// "modbus_closed"; "gateway_gone", "gateway_restarts".
[[nodiscard]] std::string_view situation_of(const RehearsalCell& cell) noexcept;

}  // namespace axisgate
