// The event port for tests: events of the test, of handlers and of services. FakeClock provides the time.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "gateway/services/ports/events.hpp"
#include "tests/unit/http/fake_clock.hpp"

namespace axisgate::http::test {

class FakeEvents : public EventPort {
public:
    explicit FakeEvents(const FakeClock& clock) : clock_(clock) {}
    void tell(Event e) {
        e.id = ++last_event;
        if (e.at_unix_ns == 0) e.at_unix_ns = clock_.now_ns;
        events_.push_back(e);
        const auto all = listeners;
        for (auto* l : all)
            l->on_event(e);
    }

    std::vector<Event> events_, noted;
    mutable std::vector<EventQuery> event_queries;
    std::uint64_t last_event = 0;
    std::set<EventListener*> listeners;

    std::vector<Event> events(const EventQuery& query) const override {
        event_queries.push_back(query);
        std::vector<Event> out;
        for (const auto& e : events_) {
            if (e.id > query.since_id && e.at_unix_ns >= query.since_unix_ns && (query.axis.empty() || e.axis == query.axis) &&
                (!query.at_least || e.severity >= *query.at_least) && (query.kind.empty() || e.kind == query.kind) &&
                (query.before_id == 0 || e.id < query.before_id)) {
                out.push_back(e);
            }
        }
        const auto over = static_cast<std::ptrdiff_t>(out.size()) - static_cast<std::ptrdiff_t>(query.limit);
        if (over > 0 && query.oldest_first) out.erase(out.end() - over, out.end());
        if (over > 0 && !query.oldest_first) out.erase(out.begin(), out.begin() + over);
        return out;
    }
    void note(Event e) override { noted.push_back(std::move(e)); }
    void listen(EventListener* l) override { listeners.insert(l); }
    void unlisten(EventListener* l) override { listeners.erase(l); }

private:
    const FakeClock& clock_;
};

inline Event event(std::string text, std::string axis = {}, Severity severity = Severity::info, std::string kind = "note") {
    Event e;
    e.severity = severity;
    e.kind = std::move(kind);
    e.axis = std::move(axis);
    e.text = std::move(text);
    return e;
}

}  // namespace axisgate::http::test
