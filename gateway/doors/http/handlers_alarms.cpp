// Handlers of alarms: the list and its actions. Answers come when the change is on the disk.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/alarms/alarm_service.hpp"
#include "gateway/services/alarms/alarm_wishes.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
std::optional<std::uint64_t> id_of(const Call& c) {
    const auto n = parse_whole(c.names[0], 1, INT64_MAX);
    if (!n || !c.context.alarms->list().find(static_cast<std::uint64_t>(*n))) return std::nullopt;
    return static_cast<std::uint64_t>(*n);
}
Response none(const Call& c) { return nothing_named("alarm", c.names[0]); }

Handled later() { return {gateway_limit, problem(504, "no_answer", "the store has not answered")}; }

/// Answers with the alarm after the change; one that has left the list is shown with the state `normal`.
AlarmService::Then answer_with(Call& c, std::uint64_t id) {
    const auto* a = c.context.alarms->list().find(id);
    auto before = a ? alarm_document(*a) : json::object();
    return [respond = c.respond, service = std::weak_ptr(c.context.alarms), id, before](const std::string& fault) mutable {
        if (!fault.empty()) return respond(problem(507, "not_stored", "done, but it could not be stored: " + fault));
        const auto d = service.lock();
        if (const auto* now = d ? d->list().find(id) : nullptr) return respond(json_response(alarm_document(*now)));
        before["state"] = "normal";
        respond(json_response(before));
    };
}
}  // namespace

std::optional<AlarmFilter> query_alarm_state(const Call& c, std::optional<Response>& fault) {
    const auto word = c.target.query.get("state");
    if (!word) return std::nullopt;
    const auto filter = alarm_filter_named(*word);
    if (!filter) fault = bad_query("state", alarm_filter_words);
    return filter;
}

Handled list_alarms(Call& c) {
    std::optional<Response> fault;
    const auto only = query_alarm_state(c, fault);
    if (fault) return *fault;
    return json_response(c.context.alarms->document(only));
}

Handled acknowledge_alarm(Call& c) {
    const auto id = id_of(c);
    if (!id) return none(c);
    std::vector<Fault> faults;
    const auto comment = read_comment(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    const auto fault = c.context.alarms->acknowledge({*id}, comment, c.origin(), answer_with(c, *id));
    if (!fault.empty()) return problem(409, "wrong_state", fault);
    return later();
}

Handled acknowledge_alarms(Call& c) {
    std::vector<Fault> faults;
    const auto wish = read_acknowledge_wish(c.body.get_object(), c.context.alarms->list(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    const auto ids = wish.ids ? *wish.ids : c.context.alarms->open();
    const auto fault = c.context.alarms->acknowledge(
        ids, wish.comment, c.origin(),
        [respond = c.respond, service = std::weak_ptr(c.context.alarms), n = ids.size()](const std::string& why) {
            if (!why.empty()) return respond(problem(507, "not_stored", "done, but it could not be stored: " + why));
            const auto d = service.lock();
            respond(json_response(json::object{{"acknowledged", n}, {"unacknowledged", d ? d->list().unacknowledged() : 0}}));
        });
    if (!fault.empty()) return problem(409, "wrong_state", fault);
    return later();
}

Handled shelve_alarm(Call& c) {
    const auto id = id_of(c);
    if (!id) return none(c);
    std::vector<Fault> faults;
    const auto wish = read_shelve_wish(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    const auto fault = c.context.alarms->shelve(*id, wish.for_s, wish.reason, c.origin(), answer_with(c, *id));
    if (!fault.empty()) return problem(409, "wrong_state", fault);
    return later();
}

Handled unshelve_alarm(Call& c) {
    const auto id = id_of(c);
    if (!id) return none(c);
    const auto fault = c.context.alarms->unshelve(*id, c.origin(), answer_with(c, *id));
    if (!fault.empty()) return problem(409, "wrong_state", fault);
    return later();
}

}  // namespace axisgate::http
