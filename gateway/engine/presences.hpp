// Presences handles lines that go up and down, and decides which side serves each drive: the device, its twin, or none. An axis never
// changes sides while it moves.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Presences {
public:
    Presences(Machine& machine, Pending& pending, Publisher& publisher, Routing& routing, Speakers& speakers, Twins& twins,
              Clients& clients, Streams& streams, Motions& motions)
        : machine_(machine),
          pending_(pending),
          publisher_(publisher),
          routing_(routing),
          speakers_(speakers),
          twins_(twins),
          clients_(clients),
          streams_(streams),
          motions_(motions) {}
    void line_state(Side& side, bool up, const std::string& why, Instant now);
    void link(Side& side, const DriveLink& link, Instant now);
    void decide(Drive& drive, Instant now);
    void handback_result(const Result& result);
    /// The device is served again as soon as all is compared and its axes rest.
    void end_handback(Drive& drive, Instant now);

private:
    void serve(Drive& drive, Presence by, std::string why, Instant now);
    void begin_handback(Drive& drive, Instant now);

    Machine& machine_;
    Pending& pending_;
    Publisher& publisher_;
    Routing& routing_;
    Speakers& speakers_;
    Twins& twins_;
    Clients& clients_;
    Streams& streams_;
    Motions& motions_;
};

}  // namespace axisgate::engine
