// FastLook configures the adapters of a line so that some of its axes are polled more often for a while, and removes the period when the
// time is over. It never lasts longer than Engine::longest_look, because the client that requested it may be gone by then.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class FastLook {
public:
    FastLook(Machine& machine, Publisher& publisher, Speakers& speakers) : machine_(machine), publisher_(publisher), speakers_(speakers) {}
    /// Empty if the request was accepted, otherwise the reason why not.
    [[nodiscard]] std::string ask_for(const std::vector<AxisId>& axes, Duration period, Instant until, Instant now);
    void end_those_over(Instant now);

private:
    Machine& machine_;
    Publisher& publisher_;
    Speakers& speakers_;
};

}  // namespace axisgate::engine
