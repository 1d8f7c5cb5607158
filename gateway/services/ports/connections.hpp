// The clients connected to the doors of the hot thread, and the closing of one connection. Results come by callbacks on the service thread.
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
    std::string id;    ///< "enip-65537": the door's name and the number of the connection there
    std::string door;  ///< "modbus", "enip"
    std::string kind;  ///< DoorConnection::kind
    std::string peer;  ///< address and port
    std::int64_t since_unix_ns = 0, received_unix_ns = 0;
    std::vector<std::string> axes;  ///< the axes that it owns, by name
    bool commands = false;          ///< its client has commanded over it
};

class ConnectionPort {
public:
    virtual ~ConnectionPort() = default;
    using List = std::optional<std::vector<ClientConnection>>;
    /// By id. Empty if the hot thread is too busy to answer.
    virtual void list_connections(std::function<void(List)> then) = 0;
    /// The connections that would be closed if this site came into force.
    virtual void closed_by(Site wanted, std::function<void(List)> then) = 0;
    enum class Closed : std::uint8_t { done, unknown, busy };
    /// Its client is lost for the axes that it commanded, and their `fail_safe` acts. `unknown` if no connection has this id (any more).
    virtual void close_connection(std::string id, Origin origin, std::function<void(Closed)> then) = 0;
};

}  // namespace axisgate
