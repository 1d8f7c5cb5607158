// Event lists: events as files that people and spreadsheets read, and those that stand behind the alarms of now.
// In: events, questions, the list of alarms. Out: texts, events. Never asks for more than the list of alarms is long.
#pragma once

#include <string>
#include <vector>

#include "gateway/services/alarms/alarm.hpp"
#include "gateway/services/ports/events.hpp"

namespace axisgate {

[[nodiscard]] std::string events_csv(const std::vector<Event>& events);
/// One line per event, whatever its text has in it.
[[nodiscard]] std::string events_text(const std::vector<Event>& events);
/// The events that raised the alarms of the list which are in that state now, the newest ones: an alarm has the id of its event. Bounded
/// by the length of the list.
[[nodiscard]] std::vector<Event> events_of_alarms(const AlarmList& alarms, const EventPort& events, const EventQuery& wanted,
                                                  AlarmFilter state);

}  // namespace axisgate
