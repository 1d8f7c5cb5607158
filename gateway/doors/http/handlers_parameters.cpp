// Handlers of an axis' parameters: the list without an exchange, one read from the drive, one written and answered by the drive; with the
// entity tag of the last write.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/preconditions.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/parameters/parameter_view.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// Of the last write: the same value written again is another state, because it was written on purpose. A parameter without a write has a
/// tag, too.
std::string parameter_tag(const StoredParameter* s) {
    if (!s) return "\"never-written\"";
    return tag_over({json_text(to_json(s->value)), s->who, s->door, std::to_string(s->at_unix_ns)});
}

/// The answer for one parameter, from copies, so that it can be made after the exchange.
Response whole(const ParameterPort& parameters, const ParameterPlace& place, const LiveParameter& live, std::string_view text,
               std::int64_t history) {
    const auto stored = parameters.stored(place.axis.spec().name);
    return with_tag(json_response(parameter_now(parameters, place, live, text, history)), parameter_tag(stored_of(stored, place.id)));
}

/// 412 with the last write, if If-Match refers to another one: nothing is sent to the drive.
std::optional<Response> refuse_other(const Call& c, const ParameterPort& parameters, const ParameterPlace& place) {
    const std::string if_match(c.request.headers.get("If-Match"));
    if (if_match.empty()) return std::nullopt;
    if (c.context.writes->contains({c.names[0], place.id})) {
        return problem_of(ServiceRefusal{
            ServiceRefusal::Why::in_use,
            fmt::format("{} of {} is being written by another client just now: read it again in a moment", place.id, c.names[0]),
            c.names[0]});
    }
    const auto stored = parameters.stored(c.names[0]);
    const auto* now = stored_of(stored, place.id);
    if (!means_another(if_match, parameter_tag(now))) return std::nullopt;
    if (!now)
        return overtaken(fmt::format("{} of {} was never written through the gateway: read it again", place.id, c.names[0]),
                         parameter_tag(now), nullptr);
    return overtaken(fmt::format("{} of {} was written by {} at {}: read it again; nothing was sent to the drive", place.id, c.names[0],
                                 now->who.empty() ? "somebody" : now->who, format_time(now->at_unix_ns)),
                     parameter_tag(now),
                     json::object{{"parameter", place.id},
                                  {"value", to_json(now->value)},
                                  {"written_at", format_time(now->at_unix_ns)},
                                  {"written_by", text_or_null(now->who)},
                                  {"written_through", text_or_null(now->door)}});
}
}  // namespace

Handled list_parameters(Call& c, const ParameterPort& parameters, const SitePort& sites) {
    const auto axis = find_axis(sites, c.names[0]);
    if (!axis) return nothing_named("axis", c.names[0]);
    if (!axis->catalogue) return json_response(json::array());
    std::optional<Response> fault;
    const ParameterFilter filter{c.target.query.get("group"), c.target.query.get("array"), query_whole(c, "first", 0, 65535, 0, fault)};
    if (fault) return *fault;
    return given(parameter_list(parameters, *axis, filter), json_answer);
}

Handled read_parameter(Call& c, AxisPort& axes, const ClockPort& clock, const ParameterPort& parameters, const SitePort& sites) {
    const auto found = find_parameter(sites, c.names[0], c.names[1]);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&found)) return problem_of(*refusal);
    const auto& place = std::get<ParameterPlace>(found);
    std::optional<Response> fault;
    const bool cached = query_flag(c, "cached", fault);
    const std::int64_t history = query_whole(c, "history", 0, 1000, 0, fault);
    if (fault) return *fault;
    if (cached || !place.parameter().readable()) {
        return whole(parameters, place, parameters.live(place.axis.id(), place.point),
                     place.parameter().readable() ? "" : "can only be written", history);
    }
    Result none;
    none.ticket = read_parameter_now(
        axes, clock, parameters, place, c.origin(),
        [&parameters, place, history, respond = c.respond, axis = c.names[0]](const std::variant<ParameterReading, Result>& answer) {
            if (const auto* r = std::get_if<Result>(&answer)) return respond(problem_of(*r, axis, "read_parameter"));
            const auto& reading = std::get<ParameterReading>(answer);
            respond(whole(parameters, place, reading.live, reading.text, history));
        });
    none.outcome = Outcome::failed;
    none.reason = Reason::no_answer;
    none.text = fmt::format("no result within {} s", gateway_limit.count());
    return {gateway_limit, problem_of(none, c.names[0], "read_parameter")};
}

Handled write_parameter(Call& c, AxisPort& axes, const ParameterPort& parameters, const SitePort& sites) {
    const auto found = find_parameter(sites, c.names[0], c.names[1]);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&found)) return problem_of(*refusal);
    const auto& place = std::get<ParameterPlace>(found);
    auto value = value_to_write(parameters, place, c.body.get_object());
    if (const auto* refusal = std::get_if<ServiceRefusal>(&value)) return problem_of(*refusal);
    if (auto refusal = refuse_other(c, parameters, place)) return *std::move(refusal);
    // Until the drive has answered and the value is stored, another client's If-Match cannot be compared.
    const std::pair key(c.names[0], place.id);
    ++(*c.context.writes)[key];
    c.respond = [writes = c.context.writes, key, respond = std::move(c.respond)](Response r) {
        if (const auto it = writes->find(key); it != writes->end() && --it->second == 0) writes->erase(it);
        respond(std::move(r));
    };
    Command command;
    command.axis = place.axis.id();
    command.body = WriteParameter{place.point, std::get<Value>(std::move(value))};
    return submit_command(c, axes, std::move(command), c.names[0], "write_parameter", 0,
                          [axis = c.names[0]](const Result& r) { return answer_of(r, axis, "write_parameter"); });
}

}  // namespace axisgate::http
