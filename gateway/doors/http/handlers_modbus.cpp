// Handlers of the Modbus door: its locks and clients, and the lock that can be changed here, with an ETag of the locks.

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/preconditions.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
using Report = std::optional<ModbusReport>;

/// Of the settings, not of the connected clients, so that a new client does not change the tag.
std::string modbus_tag(const ModbusReport& r) {
    std::string allow, functions;
    for (const auto& a : r.allow)
        allow += a + ",";
    for (const auto& f : r.functions)
        functions += f + ",";
    return tag_over({r.bind, allow, functions, r.read_only ? "read-only" : ""});
}

json::object modbus_document(const ModbusReport& report) {
    json::array allow, functions, connections;
    for (const auto& a : report.allow)
        allow.emplace_back(a);
    for (const auto& f : report.functions)
        functions.emplace_back(std::stoi(f));
    for (const auto& x : report.connections) {
        json::array holds;
        for (const auto& h : x.holds)
            holds.emplace_back(h);
        connections.push_back(json::object{{"peer", x.peer},
                                           {"requests", x.requests},
                                           {"writes", x.writes},
                                           {"exceptions", x.exceptions},
                                           {"since", format_time(x.since_unix_ns)},
                                           {"holds", std::move(holds)}});
    }
    return {{"bind", report.bind},
            {"allow", std::move(allow)},
            {"functions", std::move(functions)},
            {"read_only", report.read_only},
            {"connections", std::move(connections)}};
}

Response shown(const Report& report) {
    if (!report)
        return problem(503, "busy", "the Modbus door is switched off, or cannot say now: see modbus.bind, or come again in a moment");
    return with_tag(json_response(modbus_document(*report)), modbus_tag(*report));
}
}  // namespace

Handled get_modbus_door(Call& c, ModbusPort& modbus) {
    modbus.modbus_report([respond = c.respond](const Report& r) { respond(shown(r)); });
    return {gateway_limit, late_modbus()};
}

Handled change_modbus_door(Call& c, ModbusPort& modbus) {
    const json::object& body = c.body.get_object();
    std::vector<Fault> faults;
    for (const auto& [k, v] : body) {
        if (k != "read_only")
            faults.push_back({"/" + std::string(k), std::string(k) + " is not known here", "write {\"read_only\": true} or false"});
    }
    const auto* value = body.if_contains("read_only");
    if (!value || !value->is_bool()) faults.push_back({"/read_only", "read_only must be true or false", "write one of them"});
    if (!faults.empty()) return invalid(std::move(faults));
    auto set = [&modbus, on = value->get_bool(), origin = c.origin(), respond = c.respond](std::function<void()> done) {
        modbus.set_modbus_read_only(on, origin, [&modbus, respond, done = std::move(done)](const std::string& fault, bool not_stored) {
            if (!fault.empty()) {
                respond(not_stored ? problem(507, "not_stored", fault) : problem(503, "busy", fault));
                return done();
            }
            modbus.modbus_report([respond, done](const Report& r) {
                respond(shown(r));
                done();
            });
        });
    };
    const std::string if_match(c.request.headers.get("If-Match"));
    // In the queue of the site's changes, so that the second of two requests for the same state is refused.
    const bool taken = c.context.changes->run(
        [&modbus, set, if_match, respond = c.respond](std::function<void()> done) {
            if (if_match.empty()) return set(std::move(done));
            modbus.modbus_report([set, if_match, respond, done = std::move(done)](const Report& now) {
                if (now && !means_another(if_match, modbus_tag(*now))) return set(done);
                respond(now ? overtaken("the locks of the Modbus door were changed by another client meanwhile: read them again",
                                        modbus_tag(*now), modbus_document(*now))
                            : shown(now));
                done();
            });
        },
        thrown(c.respond));
    if (!taken) return problem(503, "busy", "too many changes wait already: try again");
    return {gateway_limit, late_modbus()};
}

}  // namespace axisgate::http
