// Rehearsal: what becomes of an axis when the one who commands it is lost, tried out on the twins of the site: one axis, one cause, one
// figure. In: families, a site, an axis, a cause, the gateway's times. Out: what was done, how long it took until the motor began to stop
// and until it stood, and how far it went. Virtual time: the same site gives the same figures. Never touches the gateway that runs: it
// makes an engine of its own, whose lines are models.
#pragma once

#include "gateway/engine/engine.hpp"
#include "gateway/site/rehearsal_cell.hpp"

namespace axisgate {

/// Takes some milliseconds to a second of a processor: not for the hot thread. `memory`: of the twins, so that they are set as the site's
/// are.
[[nodiscard]] RehearsalCell rehearse(const Families& families, const Site& site, const SiteMemory& memory, const RehearsalWish& wish);

}  // namespace axisgate
