// Remembers which client of the domain commanded an axis last, and by which of its writers, so that a client without writers counts as
// lost. It is kept by axis, so that a client with a new name for each command takes no more space.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gateway/doors/dds/bus.hpp"

namespace axisgate::dds {

class Commanders {
public:
    /// `source` commands the axis now. Returns true if it has not used this writer before, as far as it is known.
    bool note(const std::string& axis, const std::string& source, const Bus::Writer& writer);
    /// The clients that have lost their last writer by which they commanded an axis.
    [[nodiscard]] std::set<std::string> gone(const Bus::Writer& writer);
    /// All known writers, each once.
    [[nodiscard]] std::vector<Bus::Writer> writers() const;
    /// Removes the commanders of axes that do not exist any more.
    void keep(const std::function<bool(const std::string& axis)>& is_there) {
        std::erase_if(commanders_, [&is_there](const auto& c) { return !is_there(c.first); });
    }

private:
    struct Commander {
        std::string source;
        std::vector<Bus::Writer> writers;  // one of commands, one of parameter writes
    };
    std::map<std::string, Commander> commanders_;  // by axis
};

}  // namespace axisgate::dds
