// Handlers of an axis' parameters: the list without an exchange, one read from the drive now, one written and answered by the drive.
// In: calls. Out: catalogue, live value, stored value, and who wrote it when.
#include <fmt/core.h>

#include <algorithm>
#include <unordered_map>

#include "gateway/core/parameter_form.hpp"
#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/preconditions.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// Arrays up to this length are listed element by element; longer ones are one entry, so that a list stays a list.
constexpr std::uint16_t listed_elements = 256;
/// Elements answered when one array is asked for.
constexpr std::size_t most_elements_shown = 1024;

struct ParameterPlace {
    AxisPlace axis;
    Point point;
    std::string id;
    [[nodiscard]] const Parameter& parameter() const { return *axis.catalogue->parameter(point); }
};

/// The axis and the parameter of a path, or the 404 that says which is missing.
std::optional<ParameterPlace> find_parameter(const Call& c, const SitePort& sites, std::optional<Response>& fault) {
    auto axis = find_axis(sites, c.names[0]);
    if (!axis) {
        fault = nothing_named("axis", c.names[0]);
        return std::nullopt;
    }
    const auto point = axis->catalogue ? axis->catalogue->find(c.names[1]) : std::nullopt;
    if (!point) {
        std::string detail = fmt::format("a {} has no parameter {}", axis->family, c.names[1]);
        if (axis->catalogue) {
            for (const auto& p : axis->catalogue->parameters()) {
                const bool named = p.count != 0 && (c.names[1] == p.id || c.names[1] == p.name || c.names[1].starts_with(p.id + "["));
                if (named) detail = fmt::format("{} is an array: {}[{}] to {}[{}]", p.id, p.id, p.first, p.id, p.first + p.count - 1);
            }
        }
        fault = to_response(Problem{.status = 404, .reason = "unknown_point", .detail = detail, .axis = c.names[0]});
        return std::nullopt;
    }
    ParameterPlace place{std::move(*axis), *point, {}};
    place.id = place.axis.catalogue->id_of(*point);
    return place;
}

const StoredParameter* stored_of(const std::vector<StoredParameter>& list, std::string_view id) {
    const auto it = std::ranges::find(list, id, &StoredParameter::parameter);
    return it == list.end() ? nullptr : &*it;
}

/// Of the last write: the same value written again is another state, since somebody meant it. What nobody wrote has a tag too.
std::string parameter_tag(const StoredParameter* s) {
    if (!s) return "\"never-written\"";
    return tag_over({json_text(to_json(s->value)), s->who, s->door, std::to_string(s->at_unix_ns)});
}

KnownValue known_now(const ParameterPort& parameters, AxisId axis) {
    return [&parameters, axis](Point p) { return parameters.live(axis, p).value; };
}

/// Unit and range are those that hold now, where they hang on another parameter's value.
json::object document_now(const ParameterPort& parameters, const AxisPlace& axis, Point point, std::string_view id,
                          const LiveParameter& live, const StoredParameter* stored, std::string_view text) {
    json::object o = axis_parameter_document(*axis.catalogue, point, id, live, stored, text);
    const ParameterForm now = form_now(*axis.catalogue, point, known_now(parameters, axis.id()));
    o["unit"] = text_or_null(now.unit);
    o["min"] = now.min ? number(*now.min) : json::value(nullptr);
    o["max"] = now.max ? number(*now.max) : json::value(nullptr);
    return o;
}

/// What is answered for one parameter, from copies, so that it can be made after the exchange.
Response whole(const ParameterPort& parameters, const ParameterPlace& place, const LiveParameter& live, std::string_view text,
               std::int64_t history) {
    const auto stored = parameters.stored(place.axis.spec().name);
    json::object o = document_now(parameters, place.axis, place.point, place.id, live, stored_of(stored, place.id), text);
    if (history > 0) {
        json::array list;
        for (const auto& h : parameters.history(place.axis.spec().name, place.id, static_cast<std::size_t>(history))) {
            list.push_back(json::object{{"value", to_json(h.value)},
                                        {"previous", to_json(h.previous)},
                                        {"written_at", format_time(h.at_unix_ns)},
                                        {"written_by", text_or_null(h.who)},
                                        {"written_through", text_or_null(h.door)}});
        }
        o["history"] = std::move(list);
    }
    return with_tag(json_response(o), parameter_tag(stored_of(stored, place.id)));
}

/// 412 with the last write, if If-Match means another one: nothing goes to the drive.
std::optional<Response> refuse_other(const Call& c, const ParameterPort& parameters, const ParameterPlace& place) {
    const std::string if_match(c.request.headers.get("If-Match"));
    if (if_match.empty()) return std::nullopt;
    if (c.context.writes->contains({c.names[0], place.id})) {
        return to_response(Problem{
            .status = 409,
            .reason = "busy",
            .detail = fmt::format("{} of {} is being written by another client just now: read it again in a moment", place.id, c.names[0]),
            .axis = c.names[0]});
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

std::optional<Value> value_from(const json::value& v) {
    if (v.is_bool()) return Value{v.get_bool()};
    if (v.is_int64()) return Value{v.get_int64()};
    if (v.is_double()) return Value{v.get_double()};
    if (v.is_string()) return Value{std::string(v.get_string())};
    return std::nullopt;  // null, lists, objects, and whole numbers above 2^63
}
}  // namespace

Handled list_parameters(Call& c, const ParameterPort& parameters, const SitePort& sites) {
    const auto axis = find_axis(sites, c.names[0]);
    if (!axis) return nothing_named("axis", c.names[0]);
    json::array out;
    if (!axis->catalogue) return json_response(out);
    std::optional<Response> fault;
    const auto group = c.target.query.get("group");
    const auto array = c.target.query.get("array");
    const std::int64_t first = query_whole(c, "first", 0, 65535, 0, fault);
    if (fault) return *fault;
    const auto stored = parameters.stored(c.names[0]);
    std::unordered_map<std::string_view, const StoredParameter*> by_id;
    for (const auto& s : stored)
        by_id.emplace(s.parameter, &s);

    const auto put = [&](std::uint16_t index, std::uint16_t element) {
        const Point point{index, element};
        const Parameter* p = axis->catalogue->parameter(point);
        if (!p) return;
        const std::string id = axis->catalogue->id_of(point);
        const auto it = by_id.find(id);
        out.push_back(
            document_now(parameters, *axis, point, id, parameters.live(axis->id(), point), it == by_id.end() ? nullptr : it->second, ""));
    };
    bool array_found = false;
    const auto all = axis->catalogue->parameters();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Parameter& p = all[i];
        const auto index = static_cast<std::uint16_t>(i);
        if (group && p.group != *group) continue;
        if (array) {
            if ((p.id != *array && p.name != *array) || p.count == 0) continue;
            array_found = true;
            const std::uint32_t from = std::max<std::uint32_t>(p.first, static_cast<std::uint32_t>(first));
            for (std::uint32_t e = from; e < std::uint32_t{p.first} + p.count && out.size() < most_elements_shown; ++e)
                put(index, static_cast<std::uint16_t>(e));
        } else if (p.count == 0) {
            put(index, 0);
        } else if (p.count <= listed_elements) {
            for (std::uint32_t e = p.first; e < std::uint32_t{p.first} + p.count; ++e)
                put(index, static_cast<std::uint16_t>(e));
        } else {
            out.push_back(axis_parameter_document(*axis->catalogue, {index, p.first}, p.id, {}, nullptr,
                                                  fmt::format("{} elements: list them with ?array={}", p.count, p.id)));
        }
    }
    if (array && !array_found) {
        return to_response(Problem{.status = 404,
                                   .reason = "unknown_point",
                                   .detail = fmt::format("a {} has no array {}", axis->family, *array),
                                   .axis = c.names[0]});
    }
    return json_response(out);
}

Handled read_parameter(Call& c, AxisPort& axes, const ClockPort& clock, const ParameterPort& parameters, const SitePort& sites) {
    std::optional<Response> fault;
    auto place = find_parameter(c, sites, fault);
    if (fault) return *fault;
    const bool cached = query_flag(c, "cached", fault);
    const std::int64_t history = query_whole(c, "history", 0, 1000, 0, fault);
    if (fault) return *fault;
    if (cached || !place->parameter().readable()) {
        return whole(parameters, *place, parameters.live(place->axis.id(), place->point),
                     place->parameter().readable() ? "" : "can only be written", history);
    }
    Command command;
    command.axis = place->axis.id();
    command.body = ReadParameter{place->point};
    command.origin = c.origin();
    auto show = [&clock, &parameters, place = *place, history, respond = c.respond, axis = c.names[0]](const Result& r) {
        LiveParameter live = parameters.live(place.axis.id(), place.point);
        if (good(r)) {
            if (known(r.value) && live.value != r.value) {  // the sample has not come this far yet
                live.value = r.value;
                live.at_unix_ns = clock.now_unix_ns();
            }
            live.quality = Quality::good;
            respond(whole(parameters, place, live, r.text, history));
            return;
        }
        const bool silent = r.reason == Reason::no_answer || r.reason == Reason::line_down || r.reason == Reason::busy;
        if (silent && known(live.value)) {
            live.quality = Quality::stale;
            respond(whole(parameters, place, live, r.text.empty() ? name_of(r.reason) : std::string_view(r.text), history));
            return;
        }
        respond(problem_of(r, axis, "read_parameter"));
    };
    const Ticket ticket = axes.submit(std::move(command), std::move(show));
    Result none;
    none.ticket = ticket;
    none.outcome = Outcome::failed;
    none.reason = Reason::no_answer;
    none.text = fmt::format("no result within {} s", gateway_limit.count());
    return {gateway_limit, problem_of(none, c.names[0], "read_parameter")};
}

Handled write_parameter(Call& c, AxisPort& axes, const ParameterPort& parameters, const SitePort& sites) {
    std::optional<Response> fault;
    auto place = find_parameter(c, sites, fault);
    if (fault) return *fault;
    const json::object& body = c.body.get_object();
    std::vector<Fault> faults;
    for (const auto& [k, v] : body) {
        if (k != "value")
            faults.push_back(
                {"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "write {\"value\": ...} alone"});
    }
    const auto* given = body.if_contains("value");
    const auto value = given ? value_from(*given) : std::nullopt;
    if (!value) {
        faults.push_back(
            {"/value", given ? "value must be a number, a text, true or false" : "value is missing", "write {\"value\": ...}"});
    }
    if (!faults.empty()) return invalid(std::move(faults), c.names[0]);
    const Parameter& parameter = place->parameter();
    const std::string& id = place->id;
    if (!parameter.writable()) {
        return to_response(
            Problem{.status = 409, .reason = "not_writable", .detail = fmt::format("{} can only be read", id), .axis = c.names[0]});
    }
    auto checked = check_write_now(*place->axis.catalogue, place->point, *value, known_now(parameters, place->axis.id()));
    if (!checked.fault.empty()) {
        return invalid({{"/value", checked.fault, "write a value that the catalogue allows"}}, c.names[0], "out_of_range");
    }
    if (auto refusal = refuse_other(c, parameters, *place)) return *std::move(refusal);
    // Until the drive has answered and it is stored, nobody knows what If-Match of another client would be compared with.
    const std::pair key(c.names[0], id);
    ++(*c.context.writes)[key];
    c.respond = [writes = c.context.writes, key, respond = std::move(c.respond)](Response r) {
        if (const auto it = writes->find(key); it != writes->end() && --it->second == 0) writes->erase(it);
        respond(std::move(r));
    };
    Command command;
    command.axis = place->axis.id();
    command.body = WriteParameter{place->point, std::move(checked.value)};
    return submit_command(c, axes, std::move(command), c.names[0], "write_parameter", 0,
                          [axis = c.names[0]](const Result& r) { return answer_of(r, axis, "write_parameter"); });
}

}  // namespace axisgate::http
