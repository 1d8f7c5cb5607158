// Handlers of connections: the clients that are connected over EtherNet/IP and Modbus, and the closing of one. Connections of this door are
// not included.
#include <boost/json/array.hpp>

#include "gateway/doors/http/handlers.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
Response too_busy() { return problem(503, "busy", "the doors cannot say now: come again in a moment"); }
}  // namespace

Handled list_connections(Call& c, ConnectionPort& connections) {
    connections.list_connections([respond = c.respond](const std::optional<std::vector<ClientConnection>>& list) {
        if (!list) return respond(too_busy());
        json::array all;
        for (const auto& x : *list)
            all.push_back(document_of(x));
        respond(json_response(all));
    });
    return {gateway_limit, late_modbus()};
}

Handled close_connection(Call& c, ConnectionPort& connections) {
    using Closed = ConnectionPort::Closed;
    connections.close_connection(std::string(c.names[0]), c.origin(), [respond = c.respond, id = std::string(c.names[0])](Closed closed) {
        if (closed == Closed::done) return respond(nothing_left());
        respond(closed == Closed::busy ? too_busy() : nothing_named("connection", id));
    });
    return {gateway_limit, late_modbus()};
}

}  // namespace axisgate::http
