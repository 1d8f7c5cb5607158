// Handlers of motion: commands, actions, and the common start of prepared axes. The answer comes when the drive has acknowledged, when the
// command is done, or when the time has passed.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/command_reader.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
constexpr std::size_t most_axes_together = 64;

/// 422 for a command that was never sent; it also has the members of a command's answer.
Response refused(std::vector<Fault> faults, std::string_view axis, std::string_view command, bool range_only) {
    Problem p;
    p.status = 422;
    p.reason = range_only ? "out_of_range" : "invalid";
    p.detail = faults.front().text;
    if (faults.size() > 1) p.detail += fmt::format(" (and {} more)", faults.size() - 1);
    p.axis = std::string(axis);
    p.faults = std::move(faults);
    p.more["ticket"] = nullptr;
    p.more["result"] = "refused";
    p.more["command"] = std::string(command);
    return to_response(p);
}

void unknown_members(const json::object& body, std::initializer_list<std::string_view> known, std::vector<Fault>& faults) {
    for (const auto& [k, v] : body) {
        if (std::ranges::find(known, std::string_view(k)) != known.end()) continue;
        std::string list;
        for (const auto w : known)
            list += (list.empty() ? "" : ", ") + std::string(w);
        faults.push_back(
            {"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "remove it, or use one of: " + list});
    }
}
}  // namespace

Response answer_of(const Result& r, std::string_view axis, std::string_view command) {
    json::object o = command_answer(r.ticket, name_of(r.outcome), "", axis, command);
    if (r.code != 0) o["code"] = r.code;
    o["text"] = r.text;
    o["value"] = to_json(r.value);
    return json_response(o);
}

Handled command_axis(Call& c, AxisPort& axes, const SitePort& sites) {
    const auto place = find_axis(sites, c.names[0]);
    if (!place) return nothing_named("axis", c.names[0]);
    std::optional<Response> fault;
    const double wait_s = query_wait(c, fault);
    if (fault) return *fault;
    const auto* word = c.body.get_object().if_contains("command");
    const std::string_view wanted = word && word->is_string() ? std::string_view(word->get_string()) : std::string_view();
    // A client that may see a machine may stop it. Switching off is not a stop, because a suspended load would fall.
    if (!is_stop(wanted)) {
        if (auto refusal = refuse_below(c.identity, Role::operating)) return *refusal;
    }
    auto read = read_command(c.body.get_object(), place->spec().increments_per_unit, place->spec().unit);
    if (!read.body) return refused(std::move(read.faults), c.names[0], read.name, read.range_only);
    Command command;
    command.axis = place->id();
    command.body = std::move(*read.body);
    return submit_command(c, axes, std::move(command), c.names[0], read.name, wait_s,
                          [axis = c.names[0], name = read.name](const Result& r) { return answer_of(r, axis, name); });
}

Handled act_on_axis(Call& c, AxisPort& axes, const SitePort& sites) {
    const auto place = find_axis(sites, c.names[0]);
    if (!place) return nothing_named("axis", c.names[0]);
    std::optional<Response> fault;
    const double wait_s = query_wait(c, fault);
    if (fault) return *fault;
    const json::object& body = c.body.get_object();
    std::vector<Fault> faults;
    unknown_members(body, {"name", "argument", "arguments"}, faults);
    Action action;
    const auto* name = body.if_contains("name");
    if (name && name->is_string() && !name->get_string().empty() && name->get_string().size() <= 128) {
        action.name = std::string(name->get_string());
    } else {
        faults.push_back({"/name", "name must be a text of 1 to 128 bytes", "write an action of the family, as its catalogue names it"});
    }
    if (const auto* argument = body.if_contains("argument"); argument && !argument->is_null()) {
        if (argument->is_string()) {
            action.argument = std::string(argument->get_string());
        } else {
            faults.push_back({"/argument", "argument must be a text", "write it in quotes"});
        }
    }
    const auto* arguments = body.if_contains("arguments");
    if (arguments && !arguments->is_null() && !arguments->is_object()) {
        faults.push_back({"/arguments", "arguments must be an object of values by name", "write \"arguments\": {\"position\": 12.5}"});
        arguments = nullptr;
    }
    const auto* by_name = arguments && arguments->is_object() ? &arguments->get_object() : nullptr;
    if (by_name && !action.argument.empty()) faults.push_back({"/argument", "argument and arguments exclude each other", "leave one out"});
    read_arguments(*place, action, by_name, "/arguments/", faults);
    if (!faults.empty()) return refused(std::move(faults), c.names[0], action.name, false);
    Command command;
    command.axis = place->id();
    const std::string word = action.name;
    command.body = std::move(action);
    return submit_command(c, axes, std::move(command), c.names[0], word, wait_s,
                          [axis = c.names[0], word](const Result& r) { return answer_of(r, axis, word); });
}

Handled start_moves(Call& c, AxisPort& axes, const SitePort& sites) {
    static constexpr std::string_view word = "start_together";
    std::optional<Response> fault;
    const double wait_s = query_wait(c, fault);
    if (fault) return *fault;
    const json::object& body = c.body.get_object();
    std::vector<Fault> faults;
    unknown_members(body, {"axes"}, faults);
    StartTogether start;
    std::string first, line;
    const auto* listed = body.if_contains("axes");
    if (!listed || !listed->is_array() || listed->get_array().empty() || listed->get_array().size() > most_axes_together) {
        faults.push_back(
            {"/axes", fmt::format("axes must be a list of 1 to {} names", most_axes_together), "write \"axes\": [\"left\", \"right\"]"});
    } else {
        for (std::size_t i = 0; i < listed->get_array().size(); ++i) {
            const auto& v = listed->get_array()[i];
            const std::string pointer = fmt::format("/axes/{}", i);
            if (!v.is_string()) {
                faults.push_back({pointer, "the name of an axis is a text", "write it in quotes"});
                continue;
            }
            const std::string_view name = v.get_string();
            const auto place = find_axis(sites, name);
            if (!place) {
                faults.push_back({pointer, fmt::format("there is no axis {}", name), "see /api/v1/axes"});
                continue;
            }
            if (std::ranges::find(start.axes, place->id()) != start.axes.end()) {
                faults.push_back({pointer, fmt::format("{} is there twice", name), "name each axis once"});
                continue;
            }
            if (first.empty()) {
                first = std::string(name);
                line = place->line;
            } else if (place->line != line) {
                faults.push_back({pointer, fmt::format("{} is on the line {}, {} on {}", name, place->line, first, line),
                                  "start axes of different lines with a request each"});
            }
            start.axes.push_back(place->id());
        }
    }
    if (!faults.empty()) return refused(std::move(faults), first, word, false);
    Command command;
    command.axis = start.axes.front();
    command.body = std::move(start);
    return submit_command(c, axes, std::move(command), first, std::string(word), wait_s,
                          [first](const Result& r) { return answer_of(r, first, word); });
}

}  // namespace axisgate::http
