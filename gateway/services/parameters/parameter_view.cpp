// Documents are made from copies, so that they can be made after an exchange.
#include "gateway/services/parameters/parameter_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "gateway/core/parameter_form.hpp"
#include "gateway/core/text.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
/// Arrays up to this length are listed element by element; longer ones are one entry, so that the list stays short.
constexpr std::uint16_t most_elements_listed = 256;
/// Elements in the answer when one array is requested.
constexpr std::size_t most_elements_shown = 1024;

KnownValue known_value_of(const ParameterPort& parameters, AxisId axis) {
    return [&parameters, axis](Point p) { return parameters.live(axis, p).value; };
}

/// Values that the DCF of the drive gives to its parameters, by id. They refer to the catalogue.
std::unordered_map<std::string_view, const json::value*> configured_of(const Catalogue& catalogue) {
    std::unordered_map<std::string_view, const json::value*> out;
    const auto* list = catalogue.document().if_contains("configured");
    if (!list) return out;
    for (const auto& v : list->as_array())
        out.emplace(v.at("parameter").as_string(), &v.at("value"));
    return out;
}

json::object document_now(const ParameterPort& parameters, const AxisPlace& axis, Point point, std::string_view id,
                          const LiveParameter& live, const StoredParameter* stored, std::string_view text) {
    json::object o = axis_parameter_document(*axis.catalogue, point, id, live, stored, text);
    const ParameterForm now = form_now(*axis.catalogue, point, known_value_of(parameters, axis.id()));
    o["unit"] = text_or_null(now.unit);
    o["min"] = now.min ? number(*now.min) : json::value(nullptr);
    o["max"] = now.max ? number(*now.max) : json::value(nullptr);
    return o;
}

std::optional<Value> scalar_of(const json::value& v) {
    if (v.is_bool()) return Value{v.get_bool()};
    if (v.is_int64()) return Value{v.get_int64()};
    if (v.is_double()) return Value{v.get_double()};
    if (v.is_string()) return Value{std::string(v.get_string())};
    return std::nullopt;  // null, lists, objects, and whole numbers above 2^63
}
}  // namespace

Refusable<ParameterPlace> find_parameter(const SitePort& sites, const std::string& axis, const std::string& parameter, bool hints) {
    auto found = find_axis(sites, axis);
    if (!found) return no_such("axis", axis);
    const auto point = found->catalogue ? found->catalogue->find(parameter) : std::nullopt;
    if (!point) {
        std::string text = fmt::format("a {} has no parameter {}", found->family, parameter);
        for (const auto& p : hints && found->catalogue ? found->catalogue->parameters() : std::span<const Parameter>()) {
            const bool named = p.count != 0 && (parameter == p.id || parameter == p.name || parameter.starts_with(p.id + "["));
            if (named) text = fmt::format("{} is an array: {}[{}] to {}[{}]", p.id, p.id, p.first, p.id, p.first + p.count - 1);
        }
        return ServiceRefusal{ServiceRefusal::Why::unknown_point, std::move(text), axis};
    }
    ParameterPlace place{std::move(*found), *point, {}};
    place.id = place.axis.catalogue->id_of(*point);
    return place;
}

const StoredParameter* stored_of(const std::vector<StoredParameter>& list, std::string_view id) {
    const auto it = std::ranges::find(list, id, &StoredParameter::parameter);
    return it == list.end() ? nullptr : &*it;
}

Refusable<json::array> parameter_list(const ParameterPort& parameters, const AxisPlace& axis, const ParameterFilter& filter) {
    json::array out;
    if (!axis.catalogue) return out;
    const Catalogue& catalogue = *axis.catalogue;
    const auto stored = parameters.stored(axis.spec().name);
    std::unordered_map<std::string_view, const StoredParameter*> by_id;
    for (const auto& s : stored)
        by_id.emplace(s.parameter, &s);
    const auto configured = configured_of(catalogue);
    const auto put = [&](std::uint16_t index, std::uint32_t element) {
        const Point point{index, static_cast<std::uint16_t>(element)};
        if (!catalogue.parameter(point)) return;
        const std::string id = catalogue.id_of(point);
        const auto it = by_id.find(id);
        auto o = document_now(parameters, axis, point, id, parameters.live(axis.id(), point), it == by_id.end() ? nullptr : it->second, "");
        if (const auto c = configured.find(id); c != configured.end()) o["configured"] = *c->second;
        out.push_back(std::move(o));
    };
    bool array_found = false;
    const auto all = catalogue.parameters();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Parameter& p = all[i];
        const auto index = static_cast<std::uint16_t>(i);
        if (filter.group && p.group != *filter.group) continue;
        if (filter.array) {
            if ((p.id != *filter.array && p.name != *filter.array) || p.count == 0) continue;
            array_found = true;
            const std::uint32_t from = std::max<std::uint32_t>(p.first, static_cast<std::uint32_t>(filter.first));
            for (std::uint32_t e = from; e < std::uint32_t{p.first} + p.count && out.size() < most_elements_shown; ++e)
                put(index, e);
        } else if (p.count == 0) {
            put(index, 0);
        } else if (p.count <= most_elements_listed) {
            for (std::uint32_t e = p.first; e < std::uint32_t{p.first} + p.count; ++e)
                put(index, e);
        } else {
            out.push_back(axis_parameter_document(catalogue, {index, p.first}, p.id, {}, nullptr,
                                                  fmt::format("{} elements: list them with ?array={}", p.count, p.id)));
        }
    }
    if (filter.array && !array_found)
        return ServiceRefusal{ServiceRefusal::Why::unknown_point, fmt::format("a {} has no array {}", axis.family, *filter.array),
                              axis.spec().name};
    return out;
}

json::object parameter_now(const ParameterPort& parameters, const ParameterPlace& place, const LiveParameter& live, std::string_view text,
                           std::int64_t history) {
    const std::string& axis = place.axis.spec().name;
    const auto stored = parameters.stored(axis);
    json::object o = document_now(parameters, place.axis, place.point, place.id, live, stored_of(stored, place.id), text);
    const auto configured = configured_of(*place.axis.catalogue);
    if (const auto c = configured.find(place.id); c != configured.end()) o["configured"] = *c->second;
    if (history <= 0) return o;
    json::array list;
    for (const auto& h : parameters.history(axis, place.id, static_cast<std::size_t>(history))) {
        list.push_back(json::object{{"value", to_json(h.value)},
                                    {"previous", to_json(h.previous)},
                                    {"written_at", format_time(h.at_unix_ns)},
                                    {"written_by", text_or_null(h.who)},
                                    {"written_through", text_or_null(h.door)}});
    }
    o["history"] = std::move(list);
    return o;
}

json::array parameter_history(const ParameterPort& parameters, const ParameterPlace& place, std::size_t limit) {
    json::array out;
    for (const auto& h : parameters.history(place.axis.spec().name, place.id, limit))
        out.push_back(json::object{{"at", format_time(h.at_unix_ns)},
                                   {"who", text_or_null(h.who)},
                                   {"door", text_or_null(h.door)},
                                   {"old", to_json(h.previous)},
                                   {"new", to_json(h.value)}});
    return out;
}

Ticket read_parameter_now(AxisPort& axes, const ClockPort& clock, const ParameterPort& parameters, const ParameterPlace& place,
                          Origin origin, std::function<void(std::variant<ParameterReading, Result>)> then) {
    Command command;
    command.axis = place.axis.id();
    command.body = ReadParameter{place.point};
    command.origin = std::move(origin);
    return axes.submit(std::move(command), [&clock, &parameters, place, then = std::move(then)](const Result& r) {
        LiveParameter live = parameters.live(place.axis.id(), place.point);
        if (good(r)) {
            if (known(r.value) && live.value != r.value) {  // the sample has not arrived here yet
                live.value = r.value;
                live.at_unix_ns = clock.now_unix_ns();
            }
            live.quality = Quality::good;
            return then(ParameterReading{std::move(live), r.text});
        }
        const bool silent = r.reason == Reason::no_answer || r.reason == Reason::line_down || r.reason == Reason::busy;
        if (!silent || !known(live.value)) return then(r);
        live.quality = Quality::stale;
        then(ParameterReading{std::move(live), r.text.empty() ? std::string(name_of(r.reason)) : r.text});
    });
}

Refusable<Value> value_to_write(const ParameterPort& parameters, const ParameterPlace& place, const json::object& body) {
    const std::string& axis = place.axis.spec().name;
    std::vector<Fault> faults;
    for (const auto& [k, v] : body) {
        if (k != "value")
            faults.push_back(
                {"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "write {\"value\": ...} alone"});
    }
    const auto* given = body.if_contains("value");
    const auto value = given ? scalar_of(*given) : std::nullopt;
    if (!value)
        faults.push_back(
            {"/value", given ? "value must be a number, a text, true or false" : "value is missing", "write {\"value\": ...}"});
    if (!faults.empty()) return faulty(std::move(faults), axis);
    if (!place.parameter().writable())
        return ServiceRefusal{ServiceRefusal::Why::not_writable, fmt::format("{} can only be read", place.id), axis};
    auto checked = check_write_now(*place.axis.catalogue, place.point, *value, known_value_of(parameters, place.axis.id()));
    if (!checked.fault.empty())
        return faulty({{"/value", checked.fault, "write a value that the catalogue allows"}}, axis, ServiceRefusal::Why::out_of_range);
    return std::move(checked.value);
}

}  // namespace axisgate
