// The list has at most one entry per commanded axis, with at most one writer of each topic.
#include "gateway/doors/dds/commanders.hpp"

#include <algorithm>

namespace axisgate::dds {

bool Commanders::note(const std::string& axis, const std::string& source, const Bus::Writer& writer) {
    Commander& c = commanders_[axis];
    if (c.source != source) c = {source, {}};
    if (std::ranges::find(c.writers, writer) != c.writers.end()) return false;
    std::erase_if(c.writers, [&writer](const Bus::Writer& w) { return w.topic == writer.topic; });
    c.writers.push_back(writer);
    return true;
}

std::set<std::string> Commanders::gone(const Bus::Writer& writer) {
    std::set<std::string> lost;
    for (auto& [axis, c] : commanders_)
        if (std::erase(c.writers, writer) > 0) lost.insert(c.source);
    std::erase_if(commanders_, [](const auto& c) { return c.second.writers.empty(); });
    for (const auto& [axis, c] : commanders_)
        lost.erase(c.source);
    return lost;
}

std::vector<Bus::Writer> Commanders::writers() const {
    std::vector<Bus::Writer> all;
    for (const auto& [axis, c] : commanders_)
        for (const auto& w : c.writers)
            if (std::ranges::find(all, w) == all.end()) all.push_back(w);
    return all;
}

}  // namespace axisgate::dds
