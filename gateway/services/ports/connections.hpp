// Connection port: who is connected to the doors of the hot thread, and the end of one connection by hand.
// In: the id of a connection. Out: a list, or whether there was one, by callbacks on the service thread.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

struct ClientConnection {
    std::string id;    ///< "enip-65537": the door's name and the connection's number there
    std::string door;  ///< "modbus", "enip"
    std::string kind;  ///< DoorConnection::kind
    std::string peer;  ///< address and port
    std::int64_t since_unix_ns = 0, received_unix_ns = 0;
    std::vector<std::string> axes;  ///< that it owns, by name
    bool commands = false;          ///< its client has commanded by it
};

class ConnectionPort {
public:
    virtual ~ConnectionPort() = default;
    using List = std::optional<std::vector<ClientConnection>>;
    /// By id. Nothing: the hot thread is too busy to say.
    virtual void list_connections(std::function<void(List)> then) = 0;
    /// Those of them that would be closed if this site were put in force.
    virtual void closed_by(Site wanted, std::function<void(List)> then) = 0;
    enum class Closed : std::uint8_t { done, unknown, busy };
    /// What it commanded is lost, and the axes do what their `fail_safe` says. `unknown`: there is no connection of this id (any more).
    virtual void close_connection(std::string id, Origin origin, std::function<void(Closed)> then) = 0;
};

}  // namespace axisgate
