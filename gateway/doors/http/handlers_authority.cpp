// Handlers of authority: the leases of axes. A refusal names the holder and the remaining time.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/services/access/authority_view.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {

/// Gives a request to the hot thread and answers with the resulting state.
Handled submit_hold(Call& c, AxisPort& axes, const ClockPort& clock, const SitePort& sites, HoldAxis wish, bool empty_answer) {
    const auto place = find_axis(sites, c.names[0]);
    if (!place) return nothing_named("axis", c.names[0]);
    Command command;
    command.axis = place->id();
    command.body = std::move(wish);
    const std::string word(name_of(command.body));
    return submit_command(c, axes, std::move(command), c.names[0], word, 0,
                          [&axes, &clock, spec = place->spec(), id = place->id(), empty_answer](const Result&) {
                              if (!empty_answer) {
                                  auto o = authority_document(axes, clock, spec, id);
                                  add_connections(o, std::nullopt);
                                  return json_response(o);
                              }
                              return nothing_left();
                          });
}

/// Checks the members of a small body; the faults are collected.
void check_members(const json::object& body, std::initializer_list<std::string_view> known, std::vector<Fault>& faults) {
    for (const auto& [k, v] : body) {
        if (std::ranges::find(known, std::string_view(k)) == known.end()) {
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "remove it"});
        }
    }
}
}  // namespace

Origin Call::origin() const { return origin_of(request, identity, who()); }

Origin origin_of(const Request& request, const Identity& identity, std::string who) {
    Origin o{clients, std::make_shared<const std::string>(std::move(who)), {}};
    // A signed-in user is one client from every address, and each of the user's tokens is another one. Without a name, several connections
    // of one page are one client: the host, and the name that the client gives itself.
    std::string name = identity.user.empty() ? request.peer.substr(0, request.peer.rfind(':')) : identity.user;
    if (!identity.token.empty()) name += ' ' + identity.token;
    if (const auto own = trimmed(request.headers.get("X-Client")); !own.empty()) {
        name += ' ';
        for (const char x : own.substr(0, 40))
            name += static_cast<unsigned char>(x) < 0x20 || x == 0x7F ? '_' : x;
    }
    o.client = std::make_shared<const std::string>(std::move(name));
    return o;
}

Handled list_authority(Call& c, const AxisPort& axes, const ClockPort& clock, ModbusPort& modbus, const SitePort& sites) {
    const auto site = sites.site();
    auto list = std::make_shared<std::vector<json::object>>();
    for (std::size_t i = 0; i < site->site.axes.size() && i < site->axis_ids.size(); ++i)
        list->push_back(authority_document(axes, clock, site->site.axes[i], site->axis_ids[i]));
    // The context outlives every call.
    const auto answer = [list, &clock, &context = c.context](const std::optional<ModbusReport>& report) {
        json::array out;
        for (auto& o : *list) {
            add_connections(o, report);
            out.push_back(std::move(o));
        }
        return json_response(json::object{{"axes", std::move(out)}, {"clients", clients_document(*context.clients, clock, report)}});
    };
    modbus.modbus_report([answer, respond = c.respond](const std::optional<ModbusReport>& r) { respond(answer(r)); });
    return {gateway_limit, late_modbus()};
}

Handled get_authority(Call& c, const AxisPort& axes, const ClockPort& clock, ModbusPort& modbus, const SitePort& sites) {
    const auto place = find_axis(sites, c.names[0]);
    if (!place) return nothing_named("axis", c.names[0]);
    auto document = authority_document(axes, clock, place->spec(), place->id());
    if (!held_by_modbus(document)) {
        add_connections(document, std::nullopt);
        return json_response(document);
    }
    modbus.modbus_report([document = std::move(document), respond = c.respond](const std::optional<ModbusReport>& r) mutable {
        add_connections(document, r);
        respond(json_response(document));
    });
    return {gateway_limit, late_modbus()};
}

Handled take_authority(Call& c, AxisPort& axes, const ClockPort& clock, const SitePort& sites) {
    const json::object& body = c.body.get_object();
    std::vector<Fault> faults;
    check_members(body, {"ttl_s", "take_over"}, faults);
    HoldAxis wish;
    if (const auto* ttl = body.if_contains("ttl_s")) {
        const bool good = ttl->is_int64() && ttl->get_int64() >= 1 && ttl->get_int64() <= 3600;
        if (good)
            wish.lease_s = ttl->get_int64();
        else
            faults.push_back({"/ttl_s", "ttl_s must be a whole number of seconds", "write a value from 1 to 3600"});
    }
    if (const auto* over = body.if_contains("take_over")) {
        if (over->is_bool())
            wish.take_over = over->get_bool();
        else
            faults.push_back({"/take_over", "take_over must be true or false", "write one of them"});
    }
    if (!faults.empty()) return invalid(std::move(faults), c.names[0]);
    if (wish.take_over) {
        if (auto refusal = refuse_below(c.identity, Role::engineer)) return *refusal;
    }
    return submit_hold(c, axes, clock, sites, std::move(wish), false);
}

Handled release_authority(Call& c, AxisPort& axes, const ClockPort& clock, const SitePort& sites) {
    HoldAxis wish;
    wish.kind = HoldAxis::Kind::release;
    return submit_hold(c, axes, clock, sites, std::move(wish), true);
}

Handled hand_over_authority(Call& c, AxisPort& axes, const ClockPort& clock, const SitePort& sites) {
    const json::object& body = c.body.get_object();
    std::vector<Fault> faults;
    check_members(body, {"to"}, faults);
    HoldAxis wish;
    wish.kind = HoldAxis::Kind::hand_over;
    if (const auto* to = body.if_contains("to"); to && to->is_string() && !to->get_string().empty() && to->get_string().size() <= 80) {
        wish.to = std::string(to->get_string());
    } else {
        faults.push_back(
            {"/to", "to must name the next holder in 1 to 80 bytes", "write \"modbus 192.0.2.7\", or a holder as GET shows it"});
    }
    if (!faults.empty()) return invalid(std::move(faults), c.names[0]);
    return submit_hold(c, axes, clock, sites, std::move(wish), false);
}

}  // namespace axisgate::http
