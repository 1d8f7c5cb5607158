// The event port: events of services and doors go directly to the storage and return with numbers for the listeners. Bounded by the ring to
// the storage; an event that finds it full is counted.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "gateway/runtime/event_outlet.hpp"
#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/events.hpp"

namespace axisgate {

class WarmEvents final : public EventPort {
public:
    explicit WarmEvents(const WarmThreads& threads) : threads_(threads) { outlet_.connect(&threads.cold.from_service()); }
    /// Events with their numbers; called on the storage thread.
    void written(std::vector<Event> events);
    [[nodiscard]] std::uint64_t lost() const noexcept { return outlet_.lost(); }
    /// Reports an event about an action of a client.
    void note(std::string kind, std::string text, const Origin& origin, Severity severity = Severity::info);

    [[nodiscard]] std::vector<Event> events(const EventQuery& query) const override;
    void events_settled(std::function<void()> then) override;
    void note(Event event) override;
    void listen(EventListener* listener) override { listeners_.push_back(listener); }
    void unlisten(EventListener* listener) override { std::erase(listeners_, listener); }
    /// At the end, when the service thread does not run any more: delivers the numbered events to the listeners.
    void tell_all() { tell(SIZE_MAX); }

private:
    void tell(std::size_t most);
    void tell_some();

    const WarmThreads& threads_;
    EventOutlet outlet_;
    std::vector<EventListener*> listeners_;
    std::deque<Event> numbered_;  ///< not delivered to the listeners yet
};

}  // namespace axisgate
