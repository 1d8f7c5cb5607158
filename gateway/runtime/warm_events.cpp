// Listeners get events in the order of the numbers that the storage assigned. Reads of the database are local and short.
#include "gateway/runtime/warm_events.hpp"

#include <algorithm>
#include <iterator>

namespace axisgate {
namespace {
/// At once, some 5 us each: those of a whole commit take half a millisecond, during which no command would be answered.
constexpr std::size_t events_per_slice = 4;
/// A part of the waiting ones in addition, so that they do not accumulate: the more are waiting, the faster they are delivered.
constexpr std::size_t waiting_per_slice = 64;
}  // namespace

void WarmEvents::note(Event event) {
    outlet_.send(std::move(event), monotonic_now());
    threads_.cold.from_service().announce();
}

void WarmEvents::note(std::string kind, std::string text, const Origin& origin, Severity severity) {
    Event e;
    e.kind = std::move(kind);
    e.severity = severity;
    e.text = std::move(text);
    e.who = origin.who ? *origin.who : "";
    e.door = std::string(name_of(origin.door));
    note(std::move(e));
}

void WarmEvents::written(std::vector<Event> events) {
    threads_.answer([this, events = std::move(events)]() mutable {
        const bool telling = !numbered_.empty();
        std::ranges::move(events, std::back_inserter(numbered_));
        if (!telling) tell_some();
    });
}

void WarmEvents::tell(std::size_t most) {
    const auto listeners = listeners_;
    for (; most > 0 && !numbered_.empty(); --most) {
        const Event e = std::move(numbered_.front());
        numbered_.pop_front();
        for (auto* l : listeners)
            l->on_event(e);
    }
}

void WarmEvents::tell_some() {
    tell(std::max(events_per_slice, numbered_.size() / waiting_per_slice));
    if (!numbered_.empty()) threads_.answer([this] { tell_some(); });  // behind work that has arrived for others meanwhile
}

std::vector<Event> WarmEvents::events(const EventQuery& query) const {
    auto rows = threads_.reader.events(query);
    return rows ? std::move(*rows) : std::vector<Event>{};
}

/// Goes through the hot thread, behind all of its earlier requests, and then behind everything that it has given to the storage thread.
void WarmEvents::events_settled(std::function<void()> then) {
    const auto back = [this, then] { threads_.answer(then); };
    if (!threads_.on_hot([this, back](Engine&, Instant) { threads_.cold.flush(back); })) back();
}

}  // namespace axisgate
