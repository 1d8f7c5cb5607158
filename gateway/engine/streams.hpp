// Streams handles set-points that a client renews in cycles, without answers. The first one is checked like a command, and each one against
// the same limits. The begin and the end of a stream are events; everything else is state, so that a client that continues after a refusal
// causes at most one event per second.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Streams {
public:
    Streams(Machine& machine, Publisher& publisher, Routing& routing, Orders& orders, CommandAuthority& authority, LossOfCommand& loss,
            Motions& motions)
        : machine_(machine),
          publisher_(publisher),
          routing_(routing),
          orders_(orders),
          authority_(authority),
          loss_(loss),
          motions_(motions) {}
    /// Empty if the set-point was passed on, otherwise the refusal.
    std::optional<Refusal> on_set_point(const SetPoint& set_point, Instant now);
    void end(Axis& axis, Reason reason, const std::string& why, Instant now);
    void refused(const Side& side, const Out::StreamEnd& by_drive, Instant now);
    void check(Axis& axis, Instant now);

private:
    [[nodiscard]] std::optional<Refusal> against(const Axis& axis, const SetPoint& set_point, const AuthorityClient& who,
                                                 Instant now) const;
    [[nodiscard]] static std::optional<Refusal> too_far(const Axis& axis, const SetPoint& set_point, const Speaker& speaker);
    void begin(Axis& axis, const SetPoint& set_point, const AuthorityClient& who, Instant now);
    void tell(const Axis& axis, const Origin& by, Severity severity, std::string text, Instant now);

    Machine& machine_;
    Publisher& publisher_;
    Routing& routing_;
    Orders& orders_;
    CommandAuthority& authority_;
    LossOfCommand& loss_;
    Motions& motions_;
};

}  // namespace axisgate::engine
