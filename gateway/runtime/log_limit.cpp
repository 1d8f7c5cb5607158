// Counts the lines of each cause in a period. A cause is forgotten when its period is over; all causes are checked once a second at most.
#include "gateway/runtime/log_limit.hpp"

#include <algorithm>

namespace axisgate {

bool LogLimit::allows(std::string_view cause, Instant now) {
    std::string key(cause);
    if (causes_.size() >= most_causes && !causes_.contains(key)) key = "others";
    State& s = causes_[key];
    if (s.lines == 0) s.begun = now;
    return ++s.lines <= at_once;
}

std::vector<LogLimit::HeldBack> LogLimit::ended(Instant now) {
    std::vector<HeldBack> list;
    if (now < next_look_) return list;
    next_look_ = now + std::chrono::seconds(1);
    for (auto it = causes_.begin(); it != causes_.end();) {
        if (now - it->second.begun < period) {
            ++it;
            continue;
        }
        if (it->second.lines > at_once) list.push_back({it->first, it->second.lines - at_once});
        it = causes_.erase(it);
    }
    std::ranges::sort(list, {}, &HeldBack::cause);
    return list;
}

}  // namespace axisgate
