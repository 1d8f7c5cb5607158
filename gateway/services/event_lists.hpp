// Events as files for people and spreadsheets, and the events behind the present alarms.
#pragma once

#include <string>
#include <vector>

#include "gateway/services/alarms/alarm.hpp"
#include "gateway/services/ports/events.hpp"

namespace axisgate {

[[nodiscard]] std::string events_csv(const std::vector<Event>& events);
/// One line per event, whatever characters its text contains.
[[nodiscard]] std::string events_text(const std::vector<Event>& events);
/// The newest events that raised those alarms of the list that are in this state now; an alarm has the id of its event. Bounded by the
/// length of the list.
[[nodiscard]] std::vector<Event> events_of_alarms(const AlarmList& alarms, const EventPort& events, const EventQuery& wanted,
                                                  AlarmFilter state);

}  // namespace axisgate
