// Plays one loss of command on models of the site, beside the running gateway. The cell comes by a callback on the service thread, after up
// to a second; one at a time. Drives and twins of the gateway itself are not involved.
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
    /// The gateway's own times are put into the request.
    virtual void rehearse(std::shared_ptr<const SiteState> site, RehearsalWish wish, std::function<void(RehearsalCell)> then) = 0;
    /// [modbus] watchdog_ms, for axes without a value of their own.
    [[nodiscard]] virtual Duration watchdog() const = 0;
};

}  // namespace axisgate
