// Reads requests about alarms; all faults are reported together.
#include "gateway/services/alarms/alarm_wishes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <utility>

#include "gateway/core/text.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
constexpr std::size_t most_wish_text = 500;
constexpr std::size_t most_acknowledged = AlarmList::most_alarms;

/// A text member; a fault if it is not a text, or too long.
std::string short_text(const json::object& o, std::string_view key, std::vector<Fault>& faults) {
    const auto* v = o.if_contains(key);
    if (!v) return {};
    if (!v->is_string() || v->get_string().size() > most_wish_text) {
        faults.push_back(
            {"/" + std::string(key), fmt::format("{} must be a text of at most {} bytes", key, most_wish_text), "write a short text"});
        return {};
    }
    return std::string(v->get_string());
}

void only_members(const json::object& o, std::initializer_list<std::string_view> known, std::vector<Fault>& faults) {
    for (const auto& [k, v] : o) {
        if (std::ranges::find(known, std::string_view(k)) == known.end())
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)), "leave it out"});
    }
}
}  // namespace

std::string read_comment(const json::object& o, std::vector<Fault>& faults) {
    only_members(o, {"comment"}, faults);
    return short_text(o, "comment", faults);
}

AcknowledgeWish read_acknowledge_wish(const json::object& o, const AlarmList& alarms, std::vector<Fault>& faults) {
    only_members(o, {"ids", "all", "comment"}, faults);
    auto comment = short_text(o, "comment", faults);
    const auto* all = o.if_contains("all");
    const auto* list = o.if_contains("ids");
    std::vector<std::uint64_t> ids;
    if (all && !(all->is_bool() && all->get_bool()))
        faults.push_back({"/all", "all can only be true", "write {\"all\": true}, or name ids"});
    if ((all != nullptr) == (list != nullptr))
        faults.push_back({"", "one of ids and all is needed", "write {\"all\": true} or {\"ids\": [1]}"});
    if (list && (!list->is_array() || list->get_array().empty() || list->get_array().size() > most_acknowledged))
        faults.push_back({"/ids", fmt::format("ids must be a list of 1 to {} numbers", most_acknowledged), "name the alarms"});
    if (faults.empty() && list) {
        std::set<std::uint64_t> once;
        for (std::size_t i = 0; i < list->get_array().size(); ++i) {
            const auto& v = list->get_array()[i];
            const auto n = v.is_int64() && v.get_int64() > 0 ? static_cast<std::uint64_t>(v.get_int64()) : 0;
            if (n == 0 || !alarms.find(n)) {
                faults.push_back({fmt::format("/ids/{}", i), "there is no alarm of this number", "read /api/v1/alarms again"});
                break;
            }
            if (once.insert(n).second) ids.push_back(n);
        }
    }
    AcknowledgeWish wish{std::nullopt, std::move(comment)};
    if (list) wish.ids = std::move(ids);
    return wish;
}

ShelveWish read_shelve_wish(const json::object& o, std::vector<Fault>& faults) {
    only_members(o, {"for_s", "reason"}, faults);
    auto reason = short_text(o, "reason", faults);
    if (faults.empty() && trimmed(reason).empty())
        faults.push_back({"/reason", "a shelved alarm needs a reason", "say why it may be silent"});
    const auto* v = o.if_contains("for_s");
    const bool good = v && v->is_int64() && v->get_int64() >= AlarmList::least_shelf_s && v->get_int64() <= AlarmList::most_shelf_s;
    if (!good)
        faults.push_back({"/for_s",
                          fmt::format("for_s must be a whole number from {} to {}", AlarmList::least_shelf_s, AlarmList::most_shelf_s),
                          "say for how many seconds"});
    return {good ? v->get_int64() : 0, std::move(reason)};
}

}  // namespace axisgate
