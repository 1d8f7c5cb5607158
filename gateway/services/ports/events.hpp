// Event port: what happened: kept, found again, and sent to who listens.
// In: events of services and doors, queries. Out: events with their numbers, on the service thread.
// Bounded: an event that finds its way to the storage full is counted, and the gap is an event itself.
#pragma once

#include <functional>
#include <vector>

#include "gateway/core/event.hpp"
#include "gateway/core/records.hpp"

namespace axisgate {

struct EventListener {
    virtual void on_event(const Event& event) = 0;
    virtual ~EventListener() = default;
};

class EventPort {
public:
    virtual ~EventPort() = default;
    [[nodiscard]] virtual std::vector<Event> events(const EventQuery& query) const = 0;
    /// Calls `then` when events() tells of everything that has happened until now: what happened a moment ago may still be on its way to
    /// the disk. At once if the gateway is too busy to say.
    virtual void events_settled(std::function<void()> then) { then(); }
    /// Something that a door or a service wants to be kept and streamed; id and time are filled in.
    virtual void note(Event event) = 0;
    virtual void listen(EventListener* listener) = 0;
    virtual void unlisten(EventListener* listener) = 0;
};

}  // namespace axisgate
