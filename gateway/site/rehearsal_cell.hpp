// Rehearsal cell: what is asked of the rehearsal of one loss of command, and what came of it.
// In: an axis, a cause, the gateway's times. Out: what was done and how long it took. Values alone: who plays it is in the engine.
#pragma once

#include <optional>
#include <string>

#include "gateway/core/instant.hpp"
#include "gateway/site/fail_safe.hpp"

namespace axisgate {

struct RehearsalWish {
    std::string axis;  ///< of the site
    /// none: the gateway itself is gone without a word (its supply, a kill): what its drive does then.
    LossCause cause = LossCause::modbus_closed;
    Duration watchdog = std::chrono::seconds(5);   ///< [modbus] watchdog_ms
    Duration lease = std::chrono::seconds(30);     ///< how long a command holds an axis
    Duration line_away = std::chrono::seconds(2);  ///< line_lost: for how long the drive is silent
};

/// One cell of the matrix. Times in ms from the loss: from the last request, set-point or command where silence is the loss, from the
/// drive's silence for line_lost, else from the moment at which the door tells it.
struct RehearsalCell {
    std::string axis;
    LossCause cause = LossCause::none;               ///< none: the gateway is gone, and the drive alone acts
    std::optional<FailSafeAction> chosen;            ///< as the site has it; nothing: the default
    FailSafeAction taken = FailSafeAction::nothing;  ///< what the engine did
    std::string motion;                              ///< "velocity", "position", "set_points"
    double speed = 0;                                ///< at the loss, in the axis' unit/s, by the mechanics
    std::optional<double> noticed_ms;                ///< the engine acted; nothing: it did not
    std::optional<double> reaction_ms;               ///< the motor was slower than before by a tenth for the first time
    std::optional<double> standstill_ms;             ///< it stood; nothing: it went on for as long as it was watched
    double watched_ms = 0;                           ///< for how long it was watched
    double travel = 0;                               ///< from the loss until it stood or was watched no more, in the axis' unit
    std::string fault;                               ///< why there are no figures
};

}  // namespace axisgate
