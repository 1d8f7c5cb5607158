// Handlers of the fleet: the gateways of the domain with their axes, and commands to an axis of any of them. Everything goes over the fleet
// port.
#include <algorithm>
#include <utility>

#include "gateway/axis/cia402.hpp"
#include "gateway/core/text.hpp"
#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/command_reader.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {

json::object axis_document(const FleetAxis& a) {
    const auto units = [&](std::int64_t increments) { return static_cast<double>(increments) / a.increments_per_unit; };
    return {{"axis", a.name},
            {"number", std::int64_t{a.number}},
            {"family", a.family},
            {"unit", a.unit},
            {"online", a.online},
            {"simulated", a.simulated},
            {"stale", a.stale},
            {"referenced", a.referenced},
            {"moving", a.moving},
            {"target_reached", a.target_reached},
            {"fault", a.fault},
            {"warning", a.warning},
            {"state", name_of(power_state_of(a.statusword))},
            {"statusword", std::int64_t{a.statusword}},
            {"mode", std::int64_t{a.mode}},
            {"error_code", std::int64_t{a.error_code}},
            {"fail_safe_cause", std::int64_t{a.fail_safe_cause}},
            {"authority", a.authority},
            {"holder", a.holder},
            {"position", units(a.position)},
            {"velocity", units(a.velocity)},
            {"position_increments", a.position},
            {"increments_per_unit", a.increments_per_unit},
            {"at", a.at_unix_ns == 0 ? json::value() : json::value(format_time(a.at_unix_ns))},
            {"age_ms", a.age_ms < 0 ? json::value() : json::value(a.age_ms)}};
}

json::object gateway_document(const FleetGateway& g) {
    json::array axes;
    for (const auto& a : g.axes)
        axes.push_back(axis_document(a));
    return {{"gateway", g.name},
            {"instance", std::to_string(g.instance)},
            {"here", g.here},
            {"alive", g.alive},
            {"namesake", g.namesake},
            {"version", g.version},
            {"page", g.http},
            {"clock_ahead_ms", g.clock_ahead_ns / 1'000'000},
            {"uptime_s", static_cast<double>(g.uptime_ms) / 1000},
            {"silent_ms", g.silent_ms},
            {"axes", std::move(axes)}};
}
}  // namespace

Handled get_fleet(Call&, const FleetPort& fleet) {
    json::array gateways;
    for (const auto& g : fleet.fleet())
        gateways.push_back(gateway_document(g));
    return json_response(json::object{{"enabled", !gateways.empty()}, {"gateways", std::move(gateways)}});
}

Handled command_fleet_axis(Call& c, FleetPort& fleet) {
    std::optional<Response> fault;
    const double wait_s = query_wait(c, fault);
    if (fault) return *fault;
    FleetOrder order;
    order.wish = read_command_wish(c.body.get_object());
    const std::string name = order.wish.name;
    // As for an axis of this gateway: a client that may see a machine may stop it.
    if (!is_stop(order.wish.word)) {
        if (auto refusal = refuse_below(c.identity, Role::operating)) return *refusal;
    }
    order.gateway = c.names[0];
    order.axis = c.names[1];
    order.until_done = wait_s > 0;
    order.origin = c.origin();
    const std::string axis = c.names[0] + "/" + c.names[1];
    fleet.command(std::move(order), [respond = c.respond, axis, name](const Result& r) {
        if (r.reason == Reason::unknown_point) return respond(problem(404, "not_found", r.text));
        respond(good(r) ? answer_of(r, axis, name) : problem_of(r, axis, name));
    });
    if (wait_s > 0) {
        return {std::chrono::nanoseconds(std::llround(wait_s * 1e9)),
                json_response(command_answer(no_ticket, "accepted", fmt::format("not done after {} s", wait_s), axis, name))};
    }
    Result none;
    none.outcome = Outcome::failed;
    none.reason = Reason::no_answer;
    none.text =
        fmt::format("{}: no result from {} within {} s; nobody here knows whether it was done", name, c.names[0], gateway_limit.count());
    return {gateway_limit, problem_of(none, axis, name)};
}

}  // namespace axisgate::http
