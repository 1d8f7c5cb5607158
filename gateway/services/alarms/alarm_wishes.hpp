// Reads the bodies of requests about alarms: acknowledge one or several, shelve. Faults are reported with their places. Nothing is changed
// here.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gateway/services/alarms/alarm.hpp"
#include "gateway/services/fault.hpp"

namespace axisgate {

/// The comment of an acknowledgement.
[[nodiscard]] std::string read_comment(const boost::json::object& body, std::vector<Fault>& faults);

struct AcknowledgeWish {
    std::optional<std::vector<std::uint64_t>> ids;  ///< empty: all unacknowledged alarms
    std::string comment;
};
[[nodiscard]] AcknowledgeWish read_acknowledge_wish(const boost::json::object& body, const AlarmList& alarms, std::vector<Fault>& faults);

struct ShelveWish {
    std::int64_t for_s = 0;
    std::string reason;
};
[[nodiscard]] ShelveWish read_shelve_wish(const boost::json::object& body, std::vector<Fault>& faults);

}  // namespace axisgate
