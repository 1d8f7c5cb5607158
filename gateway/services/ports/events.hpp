// Events: stored, queried, and sent to listeners, on the service thread. Bounded: an event that finds the queue to the storage full is
// counted, and the gap is itself an event.
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
    /// Calls `then` when events() includes everything until now, because the last events may still be on their way to the disk. At once if
    /// the gateway is too busy to answer.
    virtual void events_settled(std::function<void()> then) { then(); }
    /// Stores and streams an event of a door or a service; id and time are filled in.
    virtual void note(Event event) = 0;
    virtual void listen(EventListener* listener) = 0;
    virtual void unlisten(EventListener* listener) = 0;
};

}  // namespace axisgate
