// Streams: set-points that are renewed in cycles without an answer. The first is looked at like a command, each by the same limits.
// In: set-points, what adapters say of them, the passing of time. Out: the newest one to its adapter; begin and end as events, all else as
// state. Never an event per cycle: a client that goes on after a refusal is told at most once a second.
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
    /// Nothing: it was handed on; else why not.
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
