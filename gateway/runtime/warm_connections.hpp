// The connection port: asks the doors of the hot thread on that thread, and reports by an event who has closed a connection. It knows doors
// only by their interface.
#pragma once

#include "gateway/runtime/warm_events.hpp"
#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/connections.hpp"

namespace axisgate {

class WarmConnections final : public ConnectionPort {
public:
    WarmConnections(const WarmThreads& threads, WarmEvents& events) : threads_(threads), events_(events) {}
    void list_connections(std::function<void(List)> then) override;
    void closed_by(Site wanted, std::function<void(List)> then) override;
    void close_connection(std::string id, Origin origin, std::function<void(Closed)> then) override;

private:
    const WarmThreads& threads_;
    WarmEvents& events_;
};

}  // namespace axisgate
