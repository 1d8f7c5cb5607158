// Warm events: the event port: what services and doors note goes straight to the storage, and comes back numbered, for who listens.
// In: events, queries; numbered events from the cold thread. Out: events on the service thread.
// Bounded: the ring to the storage; an event that finds it full is counted. Never by way of the hot thread.
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
    /// Events that the cold thread has numbered; called on the cold thread.
    void written(std::vector<Event> events);
    [[nodiscard]] std::uint64_t lost() const noexcept { return outlet_.lost(); }
    /// An event about what somebody did.
    void note(std::string kind, std::string text, const Origin& origin, Severity severity = Severity::info);

    [[nodiscard]] std::vector<Event> events(const EventQuery& query) const override;
    void events_settled(std::function<void()> then) override;
    void note(Event event) override;
    void listen(EventListener* listener) override { listeners_.push_back(listener); }
    void unlisten(EventListener* listener) override { std::erase(listeners_, listener); }
    /// At the end, when the service thread does not turn any more: listeners are told of what has been numbered.
    void tell_all() { tell(SIZE_MAX); }

private:
    void tell(std::size_t most);
    void tell_some();

    const WarmThreads& threads_;
    EventOutlet outlet_;
    std::vector<EventListener*> listeners_;
    std::deque<Event> numbered_;  ///< listeners are to be told of them
};

}  // namespace axisgate
