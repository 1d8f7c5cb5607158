// The site in force: what is kept, made anew and taken away when another one is applied.
// In: the wanted site. Out: lines, drives and axes; adapters configured, twins made and removed.
// Never disturbs what did not change.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class SiteInForce {
public:
    SiteInForce(Machine& machine, Pending& pending, Publisher& publisher, Speakers& speakers, Twins& twins, Presences& presences,
                Clients& clients, Scans& scans)
        : machine_(machine),
          pending_(pending),
          publisher_(publisher),
          speakers_(speakers),
          twins_(twins),
          presences_(presences),
          clients_(clients),
          scans_(scans) {}
    std::shared_ptr<const SiteState> put(Site site, SiteMemory memory, std::uint64_t revision, Instant now);

private:
    void drop_axis(Axis& axis, std::string_view why);
    void tell_options(std::span<LineUnit* const> lines, std::span<Drive* const> drives, Instant now);

    Machine& machine_;
    Pending& pending_;
    Publisher& publisher_;
    Speakers& speakers_;
    Twins& twins_;
    Presences& presences_;
    Clients& clients_;
    Scans& scans_;
};

}  // namespace axisgate::engine
