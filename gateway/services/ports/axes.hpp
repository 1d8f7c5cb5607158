// Axis port: the picture of each axis, and the way of commands and streamed set-points to it.
// In: commands, set-points, clients that are gone. Out: pictures at once; exactly one result per command, by a callback on the service
// thread. Bounded: so many commands wait at most; the next one is answered "busy".
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
    /// Grows with every change of the picture.
    [[nodiscard]] virtual std::uint64_t picture_revision(AxisId axis) const = 0;
    /// One command, one result; the ticket is given by the gateway and returned at once. Result::reason busy if too many wait.
    virtual Ticket submit(Command command, std::function<void(const Result&)> then) = 0;
    /// A streamed set-point, `at` included: the newest per axis counts, nothing is answered, and the axis' picture shows what came of it.
    virtual void set_point(SetPoint set_point) = 0;
    /// The last connection of a client has ended: what it commanded is treated as the axes' site entries say.
    virtual void client_lost(const AuthorityClient& who, LossCause cause) = 0;
};

}  // namespace axisgate
