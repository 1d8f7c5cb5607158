// The picture of each axis, and the way of commands and streamed set-points to it. Each command gets exactly one result, by a callback on
// the service thread. Bounded: when too many commands wait, the next one is answered "busy".
#pragma once

#include <cstdint>
#include <functional>

#include "gateway/axis/authority.hpp"
#include "gateway/axis/image.hpp"
#include "gateway/core/command.hpp"
#include "gateway/site/fail_safe.hpp"

namespace axisgate {

class AxisPort {
public:
    virtual ~AxisPort() = default;
    [[nodiscard]] virtual AxisPicture picture(AxisId axis) const = 0;
    /// Increases with every change of the picture.
    [[nodiscard]] virtual std::uint64_t picture_revision(AxisId axis) const = 0;
    /// One command, one result; the gateway assigns the ticket and returns it at once. The result has the reason busy if too many wait.
    virtual Ticket submit(Command command, std::function<void(const Result&)> then) = 0;
    /// A streamed set-point, `at` included: the newest one per axis counts, there is no answer, and the axis' picture shows its effect.
    virtual void set_point(SetPoint set_point) = 0;
    /// The last connection of a client has ended: the `fail_safe` entries of the axes that it commanded are applied.
    virtual void client_lost(const AuthorityClient& who, LossCause cause) = 0;
};

}  // namespace axisgate
