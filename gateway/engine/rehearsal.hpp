// Rehearsal: what becomes of an axis when the one who commands it is lost, tried out on the twins of the site: one axis, one cause, one
// figure. In: families, a site, an axis, a cause, the gateway's times. Out: what was done, how long it took until the motor began to stop
// and until it stood, and how far it went. Virtual time: the same site gives the same figures. Never touches the gateway that runs: it
// makes an engine of its own, whose lines are models.
#pragma once

#include <optional>
#include <string>

#include "gateway/core/instant.hpp"
#include "gateway/engine/engine.hpp"
#include "gateway/site/fail_safe.hpp"

namespace axisgate {

struct RehearsalWish {
    std::string axis;  ///< of the site
    LossCause cause = LossCause::modbus_closed;
    Duration watchdog = std::chrono::seconds(5);   ///< [modbus] watchdog_ms
    Duration lease = std::chrono::seconds(30);     ///< how long a command holds an axis
    Duration line_away = std::chrono::seconds(2);  ///< line_lost: for how long the drive is silent
};

/// One cell of the matrix. Times in ms from the loss: from the last request, set-point or command where silence is the loss, from the
/// drive's silence for line_lost, else from the moment at which the door tells it.
struct RehearsalCell {
    std::string axis;
    LossCause cause = LossCause::none;
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

/// Takes some milliseconds to a second of a processor: not for the hot thread. `memory`: of the twins, so that they are set as the site's
/// are.
[[nodiscard]] RehearsalCell rehearse(const Families& families, const Site& site, const SiteMemory& memory, const RehearsalWish& wish);

}  // namespace axisgate
