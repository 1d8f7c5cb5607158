// Polls axes more often for a while. If one axis of a request is refused, none of them is changed.
#include <algorithm>

#include "gateway/engine/fast_look.hpp"
#include "gateway/engine/flight_record.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/speakers.hpp"

namespace axisgate::engine {

std::string FastLook::ask_for(const std::vector<AxisId>& axes, Duration period, Instant until, Instant now) {
    if (FlightTap* tap = publisher_.tap()) tap->look({axes, period, until}, now);
    const FlightWithin within(publisher_.tap());
    const bool on = period > Duration::zero();
    const LineUnit* line = nullptr;
    for (const AxisId id : axes) {
        const Axis* a = machine_.axis(id);
        if (!a) return "there is no such axis";
        if (line && a->drive->line != line) return "the axes are not on one line";
        line = a->drive->line;
    }
    for (const AxisId id : axes) {
        Axis& a = *machine_.axis(id);
        a.look_period = on ? std::max(period, Engine::shortest_look_period) : Duration::zero();
        a.look_until = on ? std::min(until, now + Engine::longest_look) : Instant{};
    }
    for (Side* s : machine_.sides)
        if (&s->unit == line) speakers_.configure_side(*s, now);
    return {};
}

/// The request ends by its time even if its client is gone.
void FastLook::end_those_over(Instant now) {
    for (const auto& slot : machine_.axes) {
        if (!slot || slot->look_period == Duration::zero() || now < slot->look_until) continue;
        slot->look_period = Duration::zero();
        for (Side* s : machine_.sides)
            if (&s->unit == slot->drive->line) speakers_.configure_side(*s, now);
    }
}

}  // namespace axisgate::engine
