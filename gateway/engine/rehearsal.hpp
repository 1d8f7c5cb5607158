// Tries out on the twins of the site how an axis reacts when the client that commands it is lost: one axis, one cause, one set of figures
// (the action, the time until the motor began to stop and until it stood, the distance). It runs in virtual time, so the same site gives
// the same figures. The running gateway is not involved: the rehearsal has an engine of its own, whose lines are models.
#pragma once

#include "gateway/engine/engine.hpp"
#include "gateway/site/rehearsal_cell.hpp"

namespace axisgate {

/// Takes from some milliseconds to a second of processor time, so it must not run on the hot thread. `memory` is that of the twins, which
/// gives them the settings of the site.
[[nodiscard]] RehearsalCell rehearse(const Families& families, const Site& site, const SiteMemory& memory, const RehearsalWish& wish);

}  // namespace axisgate
