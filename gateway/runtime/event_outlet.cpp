// A gap is reported once, before the event that follows it.
#include "gateway/runtime/event_outlet.hpp"

#include <fmt/core.h>

namespace axisgate {

void EventOutlet::send(Event event, Instant at) {
    if (!ring_) return;
    const auto lost = lost_.load(std::memory_order_relaxed);
    if (lost > reported_) {
        Event gap;
        gap.severity = Severity::warning;
        gap.kind = "gap";
        gap.text = fmt::format("{} events could not be taken: more came than can be written", lost - reported_);
        if (ring_->push(EventAt{std::move(gap), at})) reported_ = lost;
    }
    if (!ring_->push(EventAt{std::move(event), at})) lost_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace axisgate
