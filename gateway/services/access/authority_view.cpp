// Reads the authority from the pictures of the axes.
#include "gateway/services/access/authority_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "gateway/core/text.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/site/ways_in.hpp"

namespace axisgate {
namespace json = boost::json;

json::object authority_document(const AxisPort& axes, const ClockPort& clock, const AxisSpec& spec, AxisId id) {
    const AxisPicture p = axes.picture(id);
    const std::int64_t now = clock.now_unix_ns();
    const std::int64_t until = p.authority_holder[0] != 0 ? clock.to_unix_ns(p.authority_until) : 0;
    const bool held = until > now;
    json::object o{{"axis", spec.name},
                   {"door", name_of(held ? p.authority : Door::none)},
                   {"holder", held ? p.authority_holder.data() : ""},
                   {"mode", name_of(spec.authority_mode)}};
    o["expires_in_s"] = held ? number(static_cast<double>((until - now) / 1'000'000) / 1000.0) : json::value(nullptr);
    o["since"] = held ? json::value(format_time(clock.to_unix_ns(p.authority_since))) : json::value(nullptr);
    o["last_commander"] = p.authority_commander.data();
    return o;
}

void add_connections(json::object& document, const std::optional<ModbusReport>& report) {
    const std::string axis(document.at("axis").get_string()), holder(document.at("holder").get_string());
    json::array peers;
    std::string list;
    if (report && document.at("door") == json::value("modbus")) {
        for (const auto& x : report->connections) {
            if (std::ranges::find(x.holds, axis) == x.holds.end()) continue;
            peers.emplace_back(x.peer);
            list += (list.empty() ? "" : ", ") + x.peer;
        }
    }
    const std::string door(document.at("door").get_string());
    document["holder_text"] = holder.empty() ? std::string("nobody")
                              : peers.size() > 1
                                  ? fmt::format("{} {}: one client with {} connections, {}", door, holder, peers.size(), list)
                              : peers.size() == 1 ? fmt::format("{} {}, connected from {}", door, holder, list)
                                                  : fmt::format("{} {}", door, holder);
    document["connections"] = std::move(peers);
}
json::array clients_document(const ClientsSeen& clients, const ClockPort& clock, const std::optional<ModbusReport>& report) {
    json::array out;
    for (const auto& x : clients.list(clock.now_unix_ns())) {
        out.push_back(json::object{{"client", "http " + x.name}, {"door", "http"}, {"at", format_time(x.at_unix_ns)}});
    }
    std::set<std::string> hosts;
    if (report) {
        for (const auto& x : report->connections) {
            const std::string host = x.peer.substr(0, x.peer.rfind(':'));
            if (hosts.insert(host).second) out.push_back(json::object{{"client", "modbus " + host}, {"door", "modbus"}, {"at", nullptr}});
        }
    }
    return out;
}
bool held_by_modbus(const json::object& document) {
    return document.at("door") == json::value("modbus") && !document.at("holder").get_string().empty();
}

void end_leases_of(AxisPort& axes, const SitePort& sites, std::string_view client, const std::string& by) {
    const std::string prefix = std::string(client) + ' ';
    for (const AxisId id : sites.site()->axis_ids) {
        const AxisPicture p = axes.picture(id);
        const std::string holder = p.authority_holder.data();
        if (!has_users(p.authority) || (holder != client && !holder.starts_with(prefix))) continue;
        Command command;
        command.axis = id;
        command.origin = {p.authority, std::make_shared<const std::string>(by), std::make_shared<const std::string>(holder)};
        HoldAxis wish;
        wish.kind = HoldAxis::Kind::release;
        command.body = wish;
        (void)axes.submit(std::move(command), [](const Result&) {});
        axes.client_lost({p.authority, holder}, LossCause::lease_ended);
    }
}

}  // namespace axisgate
