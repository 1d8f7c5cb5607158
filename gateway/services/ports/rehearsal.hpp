// Rehearsal port: plays one loss of command on models of the site, beside the gateway that runs.
// In: a site, an axis, a cause, what else shall happen. Out: the cell, by a callback on the service thread, after up to a second. One at a
// time. Never touches a drive or a twin of the gateway itself.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "gateway/site/rehearsal_cell.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

class RehearsalPort {
public:
    virtual ~RehearsalPort() = default;
    /// The gateway's own times are put into the wish.
    virtual void rehearse(std::shared_ptr<const SiteState> site, RehearsalWish wish, std::function<void(RehearsalCell)> then) = 0;
    /// [modbus] watchdog_ms: where an axis does not say it.
    [[nodiscard]] virtual Duration watchdog() const = 0;
};

}  // namespace axisgate
