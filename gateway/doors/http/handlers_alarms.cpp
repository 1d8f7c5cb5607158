// Handlers of alarms: the list, and what people do about it.
// In: calls. Out: the list or one alarm; answers come when it is on disk.
// Never decides what an alarm is: AlarmList does.
#include <fmt/core.h>

#include <algorithm>
#include <boost/json/array.hpp>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/alarms/alarm_service.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
constexpr std::size_t most_text = 500;
constexpr std::size_t most_ids = AlarmList::most_alarms;

std::optional<std::uint64_t> id_of(const Call& c) {
    const auto n = parse_whole(c.names[0], 1, INT64_MAX);
    if (!n || !c.context.alarms->list().find(static_cast<std::uint64_t>(*n))) return std::nullopt;
    return static_cast<std::uint64_t>(*n);
}
Response none(const Call& c) { return nothing_named("alarm", c.names[0]); }

/// A text member; faults if it is none or too long.
std::string text_member(const json::object& o, std::string_view key, std::vector<Fault>& faults) {
    const auto* v = o.if_contains(key);
    if (!v) return {};
    if (!v->is_string() || v->get_string().size() > most_text) {
        faults.push_back(
            {"/" + std::string(key), fmt::format("{} must be a text of at most {} bytes", key, most_text), "write a short text"});
        return {};
    }
    return std::string(v->get_string());
}

void only(const json::object& o, std::initializer_list<std::string_view> known, std::vector<Fault>& faults) {
    for (const auto& [k, v] : o) {
        if (std::ranges::find(known, std::string_view(k)) == known.end())
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "leave it out"});
    }
}

Handled later() { return {gateway_limit, problem(504, "no_answer", "the store has not answered")}; }

/// Answers with the alarm as it is then; one that is off the list is told as it was, in the state `normal`.
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
    const auto& o = c.body.get_object();
    only(o, {"comment"}, faults);
    const auto comment = text_member(o, "comment", faults);
    if (!faults.empty()) return invalid(std::move(faults));
    const auto fault = c.context.alarms->acknowledge({*id}, comment, c.origin(), answer_with(c, *id));
    if (!fault.empty()) return problem(409, "wrong_state", fault);
    return later();
}

Handled acknowledge_alarms(Call& c) {
    std::vector<Fault> faults;
    const auto& o = c.body.get_object();
    only(o, {"ids", "all", "comment"}, faults);
    const auto comment = text_member(o, "comment", faults);
    const auto* all = o.if_contains("all");
    const auto* list = o.if_contains("ids");
    std::vector<std::uint64_t> ids;
    if (all && !(all->is_bool() && all->get_bool()))
        faults.push_back({"/all", "all can only be true", "write {\"all\": true}, or name ids"});
    if ((all != nullptr) == (list != nullptr))
        faults.push_back({"", "one of ids and all is needed", "write {\"all\": true} or {\"ids\": [1]}"});
    if (list && (!list->is_array() || list->get_array().empty() || list->get_array().size() > most_ids))
        faults.push_back({"/ids", fmt::format("ids must be a list of 1 to {} numbers", most_ids), "name the alarms"});
    if (faults.empty() && list) {
        std::set<std::uint64_t> once;
        for (std::size_t i = 0; i < list->get_array().size(); ++i) {
            const auto& v = list->get_array()[i];
            const auto n = v.is_int64() && v.get_int64() > 0 ? static_cast<std::uint64_t>(v.get_int64()) : 0;
            if (n == 0 || !c.context.alarms->list().find(n)) {
                faults.push_back({fmt::format("/ids/{}", i), "there is no alarm of this number", "read /api/v1/alarms again"});
                break;
            }
            if (once.insert(n).second) ids.push_back(n);
        }
    }
    if (!faults.empty()) return invalid(std::move(faults));
    if (!list) ids = c.context.alarms->open();
    const auto fault = c.context.alarms->acknowledge(
        ids, comment, c.origin(), [respond = c.respond, service = std::weak_ptr(c.context.alarms), n = ids.size()](const std::string& why) {
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
    const auto& o = c.body.get_object();
    only(o, {"for_s", "reason"}, faults);
    const auto reason = text_member(o, "reason", faults);
    if (faults.empty() && trimmed(reason).empty())
        faults.push_back({"/reason", "a shelved alarm needs a reason", "say why it may be silent"});
    const auto* v = o.if_contains("for_s");
    const bool good = v && v->is_int64() && v->get_int64() >= AlarmList::least_shelf_s && v->get_int64() <= AlarmList::most_shelf_s;
    if (!good)
        faults.push_back({"/for_s",
                          fmt::format("for_s must be a whole number from {} to {}", AlarmList::least_shelf_s, AlarmList::most_shelf_s),
                          "say for how many seconds"});
    if (!faults.empty()) return invalid(std::move(faults));
    const auto fault = c.context.alarms->shelve(*id, v->get_int64(), reason, c.origin(), answer_with(c, *id));
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
