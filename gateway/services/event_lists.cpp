// One line, or one row, per event.
#include "gateway/services/event_lists.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/core/text.hpp"

namespace axisgate {

std::string events_csv(const std::vector<Event>& events) {
    std::string out = "id,at,severity,kind,axis,drive,line,code,text,who,door,parameter,old,new\r\n";
    for (const auto& e : events) {
        out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", e.id, format_time(e.at_unix_ns), name_of(e.severity),
                           csv_cell(e.kind), csv_cell(e.axis), csv_cell(e.drive), csv_cell(e.line),
                           e.code == 0 ? std::string() : std::to_string(e.code), csv_cell(e.text), csv_cell(e.who), csv_cell(e.door),
                           csv_cell(e.parameter), csv_cell(e.old_value), csv_cell(e.new_value));
    }
    return out;
}

std::string events_text(const std::vector<Event>& events) {
    std::string out;
    for (const auto& e : events) {
        const std::string& about = !e.axis.empty() ? e.axis : !e.drive.empty() ? e.drive : e.line;
        std::string line = fmt::format("{} {:7} {:12} {:16} {}", format_time(e.at_unix_ns), name_of(e.severity), e.kind,
                                       about.empty() ? "-" : about, e.text);
        if (!e.parameter.empty()) line += fmt::format(" [{}: {} -> {}]", e.parameter, e.old_value, e.new_value);
        if (e.code != 0) line += fmt::format(" (code {})", e.code);
        if (!e.who.empty()) line += fmt::format(" by {}", e.who);
        for (char& x : line) {
            if (static_cast<unsigned char>(x) < 0x20 || x == 0x7F) x = ' ';
        }
        out += line + "\n";
    }
    return out;
}

std::vector<Event> events_of_alarms(const AlarmList& alarms, const EventPort& events, const EventQuery& wanted, AlarmFilter state) {
    std::vector<Event> out;
    std::vector<std::uint64_t> ids;
    for (const auto& [id, alarm] : alarms.all()) {
        if (fits(alarm, state) && id > wanted.since_id && (wanted.before_id == 0 || id < wanted.before_id)) ids.push_back(id);
    }
    if (!wanted.oldest_first) std::ranges::reverse(ids);
    for (const auto id : ids) {
        if (out.size() >= wanted.limit) break;
        EventQuery one = wanted;
        one.since_id = id - 1;
        one.before_id = id + 1;
        one.limit = 1;
        for (auto& e : events.events(one))
            out.push_back(std::move(e));
    }
    return out;
}

}  // namespace axisgate
