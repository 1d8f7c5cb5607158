// Fast look: axes of one line that are asked more often for a while.
// In: which axes, how often, until when. Out: the line's adapters configured with that period, and without it when the time is over.
// Never for longer than Engine::longest_look: nobody who asked needs to be there to say that it is enough.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class FastLook {
public:
    FastLook(Machine& machine, Publisher& publisher, Speakers& speakers) : machine_(machine), publisher_(publisher), speakers_(speakers) {}
    /// Empty: so it is; else why not.
    [[nodiscard]] std::string ask_for(const std::vector<AxisId>& axes, Duration period, Instant until, Instant now);
    void end_those_over(Instant now);

private:
    Machine& machine_;
    Publisher& publisher_;
    Speakers& speakers_;
};

}  // namespace axisgate::engine
